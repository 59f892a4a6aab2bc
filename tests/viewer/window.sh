#!/usr/bin/env bash
# Six tests of a real window: `window.sh AIRLIGHT`. It needs Xvfb with GLX, a window manager and xdotool; without them it is skipped.
set -uo pipefail
airlight=$1
for tool in Xvfb openbox xdotool; do
  command -v $tool >/dev/null || { echo "Skipped: there is no $tool"; exit 77; }
done
work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null; wait 2>/dev/null; rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; cat "$work/view.log" 2>/dev/null; exit 1; }

# 1. Without a display: one line that points to render, and exit code 4.
DISPLAY='' WAYLAND_DISPLAY='' "$airlight" view window >"$work/none.out" 2>"$work/none.err"
[ $? -eq 4 ] || fail "without a display the exit code is not 4"
[ "$(wc -l <"$work/none.err")" -eq 1 ] && grep -q 'airlight render' "$work/none.err" || fail "without a display: $(cat "$work/none.err")"

mkfifo "$work/number"
Xvfb -displayfd 5 -screen 0 1024x700x24 +extension GLX >"$work/x.log" 2>&1 5>"$work/number" &
read -r number <"$work/number" || { echo "Skipped: Xvfb does not start"; exit 77; }
export DISPLAY=:$number
openbox >"$work/openbox.log" 2>&1 &
for _ in $(seq 100); do xdotool get_num_desktops >/dev/null 2>&1 && break; sleep 0.1; done # until it manages windows
open_window() { # [SCENE]
  "$airlight" view "$@" --size 480x270 --alpha 64 --theta 256 --phi 128 --shadow-map 256 --looks flat --tone-map aces -o "$work/out" >"$work/view.log" 2>&1 &
  pid=$!
  for _ in $(seq 300); do
    window=$(xdotool search --onlyvisible --pid $pid 2>/dev/null | head -1)
    [ -n "$window" ] && break
    kill -0 $pid 2>/dev/null || fail "the window did not open"
    sleep 0.1
  done
  [ -n "$window" ] || fail "no window is seen"
  xdotool windowactivate --sync "$window" 2>/dev/null
}
written() { # ENDING
  for _ in $(seq 300); do
    ls "$work"/out/*"$1" >/dev/null 2>&1 && return
    sleep 0.1
  done
  fail "no $1 was written"
}

# 2. A picture by its key, of the window's size, with the command that repeats it.
open_window window
xdotool key --window "$window" F12
written .png
written .exr
grep -aq -- '--looks=flat .*--tone-map=aces' "$work"/out/*_001.exr || fail "the command in the picture is not what the window was opened by"
# 3. A drag moves the camera: a later picture is another. (A window manager may still be moving the window at the first try.)
moved=
for try in 2 3 4 5 6; do
  xdotool mousemove --window "$window" 400 150 mousedown 1 mousemove_relative -- 30 0 mousemove_relative -- 30 5 mouseup 1
  sleep 1
  xdotool key --window "$window" F12
  written _00$try.png
  cmp -s "$work"/out/*_001.png "$work"/out/*_00$try.png || { moved=1; break; }
done
[ -n "$moved" ] || fail "dragging moved nothing"
# 4. Resized, minimised and brought back, it goes on, and costs nothing at rest.
xdotool windowsize "$window" 600 400
sleep 1
xdotool windowminimize "$window"
sleep 1
xdotool windowactivate --sync "$window" 2>/dev/null || xdotool windowmap "$window"
sleep 1
kill -0 $pid 2>/dev/null || fail "it did not survive being resized and minimised"
for _ in $(seq 100); do # until it rests
  before=$(awk '{print $14 + $15}' /proc/$pid/stat)
  sleep 2
  used=$(($(awk '{print $14 + $15}' /proc/$pid/stat) - before))
  [ "$used" -le 10 ] && break # hundredths of a second
done
[ "$used" -le 10 ] || fail "at rest it takes $used hundredths of a second in two"
# 5. Closed by the window manager, it ends with 0.
xdotool key --window "$window" Escape
for _ in $(seq 100); do kill -0 $pid 2>/dev/null || break; sleep 0.1; done
wait $pid
[ $? -eq 0 ] || fail "it did not end well"
[ ! -s "$work/view.log" ] || fail "it said something"
# 6. Without a scene it opens the one that its help names.
usual=$("$airlight" view --help | grep -o '(default: [a-z]*)' | head -1)
open_window
[ "$(xdotool getwindowname "$window")" = "$(sed 's/(default: \(.*\))/\1 - Airlight/' <<<"$usual")" ] || fail "without a scene it opens $(xdotool getwindowname "$window")"
for _ in $(seq 100); do # a window that has just opened may not listen yet
  xdotool key --window "$window" Escape 2>/dev/null
  sleep 0.2
  kill -0 $pid 2>/dev/null || break
done
kill -0 $pid 2>/dev/null && fail "without a scene it does not close"
wait $pid || fail "without a scene it did not end well"
echo "six tests of a real window passed"
