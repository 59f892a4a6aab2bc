#!/usr/bin/env bash
# Opens a report from disk in a headless Chromium and walks through it by its keys: `page.sh AIRLIGHT`. Nothing may reach the
# console, nothing may be asked for, and at the width of a laptop, a tablet and a phone nothing may stand beyond the side.
set -uo pipefail
airlight=$(realpath "$1")
here=$(realpath "$(dirname "$0")")
source "$here/chromium.sh"
[ -n "$chromium" ] || { echo "Skipped: there is no chromium"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "FAILED: $*"; exit 1; }

volumes=vsv:alpha=32:theta=64:phi=128,vsv:alpha=64:theta=128:phi=128,march:steps=16
"$airlight" compare cornell --size 64x64 --frames 1 --shadow-map 128 --volume $volumes -o compared --quiet >/dev/null &&
  "$airlight" sweep cornell --size 64x64 --frames 6 --shadow-map 128 --volume 'vsv:alpha={32,64}:theta=64:phi=128,march:steps={8,16}' -o swept --quiet &&
  "$airlight" report swept compared -o report.html --quiet || fail "the report is not written"

# The page once more, with what walks through it at its end.
{ cat report.html; echo '<script type="module">'; cat "$here/walk.js"; echo '</script>'; } >walk.html
open_page() { # WIDTH PAGE OPTIONS...
  local width=$1 page=$2
  shift 2
  headless "$work/profile" --window-size="$width,900" --virtual-time-budget=60000 --enable-logging=stderr "$@" "file://$work/$page" \
    2>"$work/log"
}
for width in 1280 820 500; do
  open_page $width walk.html --dump-dom >dom.html || { cat log; fail "chromium ends with $?"; }
  walked=$(sed -n 's/.*<p id="walked">\([^<]*\)<.*/\1/p' dom.html)
  [ "$walked" = passed ] || fail "$width pixels wide: ${walked:-the walk does not end}; $(grep -m3 CONSOLE log)"
  ! grep -q CONSOLE log || fail "$width pixels wide, the console: $(grep -m3 CONSOLE log)"
done
# Without scripts, too, the tables stand there.
grep -q '^<tr data-run.*march:<wbr>steps=16</th><td' report.html || fail "without scripts there is no table"
echo "a report walked through at three widths"
