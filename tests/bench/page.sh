#!/usr/bin/env bash
# `tests/bench/page.sh REPORT.html [OUT]`: what a report weighs, when its first picture is there, and how it looks at three widths
# (OUT/page-WIDTH.png). The time is from the start of the navigation, the median of five openings by a headless Chromium.
set -euo pipefail
[ $# -ge 1 ] || { echo "usage: tests/bench/page.sh REPORT.html [OUT]" >&2; exit 2; }
report=$(realpath "$1")
out=$(realpath "${2:-out}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
source "$(dirname "$0")/../page/chromium.sh"
open_page() { headless "$work/profile" "$@" 2>/dev/null; }
# Chromium writes the page down when it is loaded: an image that is long in coming holds that up until the viewer has painted.
python3 -c '
import http.server, time
class Late(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        time.sleep(4)
        self.send_error(404)
server = http.server.HTTPServer(("127.0.0.1", 0), Late)
print(server.server_port, flush=True)
server.serve_forever()' 2>/dev/null >"$work/port" &
trap 'kill %1; rm -rf "$work"' EXIT
until [ -s "$work/port" ]; do sleep 0.1; done
{ sed '/http-equiv="Content-Security-Policy"/d' "$report"; cat <<SCRIPT
<img src="http://127.0.0.1:$(cat "$work/port")/" alt="">
<script>
  const say = (marks) => marks.length ? document.body.append(\`FIRST \${Math.round(marks[0].startTime)} ms\`) : setTimeout(look, 5);
  const look = () => say(performance.getEntriesByName("first picture"));
  look();
</script>
SCRIPT
} >"$work/timed.html"
for _ in 1 2 3 4 5; do
  open_page --window-size=1440,900 --dump-dom "file://$work/timed.html" | grep -o 'FIRST [0-9]* ms' || true
done | sort -k2n >"$work/times"
echo "$(wc -c <"$report") bytes; first picture after $(sed -n 3p "$work/times" | cut -d' ' -f2-) (five times: $(cut -d' ' -f2 "$work/times" | tr '\n' ' ')ms)"
for width in 1440 820 390; do
  # A window of Chromium is not narrower than 500 pixels: a frame within it is.
  printf '<!doctype html><body style="margin:0"><iframe src="file://%s" style="border:0;width:%spx;height:2400px"></iframe>' "$report" $width >"$work/frame.html"
  open_page --window-size="$((width < 500 ? 500 : width)),2400" --allow-file-access-from-files --virtual-time-budget=10000 \
    --screenshot="$out/page-$width.png" "file://$work/frame.html"
done
