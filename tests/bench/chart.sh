#!/usr/bin/env bash
# `tests/bench/chart.sh FILE.svg DIR...`: the chart of `airlight report DIR...` as an SVG file. A headless Chromium draws it, by the
# page's own scripts, as the page's button does. Says when and on what its runs were measured, for a caption.
set -euo pipefail
airlight=${AIRLIGHT:-build/release/airlight}
[ $# -ge 2 ] || { echo "usage: tests/bench/chart.sh FILE.svg DIR..." >&2; exit 2; }
chart=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$airlight" report "$@" -o "$work/report.html" --quiet
source "$(dirname "$0")/../page/chromium.sh"
headless "$work/profile" --window-size=1200,900 --virtual-time-budget=10000 --dump-dom "file://$work/report.html" \
  2>/dev/null >"$work/dom.html"
tr '\n' ' ' <"$work/dom.html" | sed 's/.*<div id="chart">\(<svg.*<\/svg>\)<\/div>.*/\1/; s/ \(role\|tabindex\|data-run\|aria-[a-z]*\)="[^"]*"//g; s/<\/div>.*//' >"$chart"
grep -q '^<svg' "$chart" || { echo "chart.sh: the page has no chart" >&2; exit 1; }
runs=("$1"/*.jsonl "$1"/results.json)
for file in "${runs[@]}"; do
  [ -f "$file" ] || continue
  grep -o '"renderer": *"[^"]*"' -m1 "$file" | head -1 | sed "s/.*: *\"\(.*\)\"/$(date -r "$file" +%F), \1, commit $(git rev-parse --short HEAD)/"
  break
done
