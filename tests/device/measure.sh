#!/bin/sh
# Tests and measures Airlight on this machine's OpenGL driver: `./measure.sh [FIGURES.md]`, in a folder that
# tests/device/pack.sh made. Writes one file as it goes, so that what was measured before an interruption is there.
# SIZES="512 1024": the images' sides. TESTS='*_test': which test programs. LIMIT=300: seconds that one program may take.
# Exit: 0 done, 1 a test failed or a program did; the file says which.
pack=$(cd "$(dirname "$0")" && pwd)
figures=${1:-figures.md}
case $figures in /*) ;; *) figures=$PWD/$figures ;; esac
sizes=${SIZES:-512 1024}
limit=${LIMIT:-300}
tests=${TESTS:-*_test}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

. "$pack/bin/libraries.sh"
PATH=$pack/bin:$PATH
# What the tests read: see tests/support/paths.h and shared.h.
export AIRLIGHT_ASSETS="$pack/assets" AIRLIGHT_BINARY="$pack/bin/airlight" AIRLIGHT_SCHEMA="$pack/results.schema.json" \
  AIRLIGHT_EXPECTED_IMAGES="$pack/expected" AIRLIGHT_SHARED="$pack"
status=0
say() { printf '%s\n' "$*" | tee -a "$figures"; }
now() { date +%s; }

: >"$figures" || exit 1
say "# Airlight $(cat "$pack/commit") on $(airlight info | sed -n 's/^renderer *//p')"
say
say '```'
airlight info 2>&1 | tee -a "$figures"
say "CPU                       $(sed -n 's/^model name.*: //p' /proc/cpuinfo | sort | uniq -c | sed 's/^ *//; s/ / × /')"
say "kernel                    $(uname -sr)"
say "C library                 $(getconf GNU_LIBC_VERSION 2>/dev/null), the pack's $(cat "$pack/lib/c/version")"
say "loader                    $AIRLIGHT_LOADER"
say "libraries                 $AIRLIGHT_LIBRARIES"
say '```'
airlight info >/dev/null 2>&1 || { say "No OpenGL 4.5 context: nothing more can be measured."; exit 1; }

say
say "## Tests"
say
# Each program in parts, all at once, as ctest runs them: a lent machine has many processors and little time.
parts=$((($(nproc) + 3) / 4))
start=$(now)
for program in "$pack"/bin/$tests; do
  part=0
  while [ "$part" -lt "$parts" ]; do
    name=$(basename "$program").$part
    (
      GTEST_TOTAL_SHARDS=$parts GTEST_SHARD_INDEX=$part timeout "$limit" "$program" >"$name.log" 2>&1
      echo $? >"$name.code"
    ) &
    part=$((part + 1))
  done
done
wait
say "In $parts parts each, all at once: $(($(now) - start)) s."
say
say "| program | passed | failed | skipped | exit of each part |"
say "|---|---:|---:|---:|---|"
# lines PATTERN PROGRAM: how many lines of its parts' outputs match.
lines() { cat "$2".*.log | grep -c "$1"; }
for program in "$pack"/bin/$tests; do
  name=$(basename "$program")
  grep -qvx 0 "$name".*.code && status=1
  # A test that was skipped counts as passed in GoogleTest's own sum.
  skipped=$(lines '^\[  SKIPPED \].* ms)$' "$name")
  passed=$(lines '^\[       OK \]' "$name")
  failed=$(lines '^\[  FAILED  \].* ms)$' "$name")
  say "| $name | $passed | $failed | $skipped | $(cat "$name".*.code | tr '\n' ' ')|"
done
say
say "Exit 124: the $limit s that one program may take were over."
# What the failed ones said, and the end of a program that broke off.
for log in *_test.*.log; do
  awk '/^\[ RUN/ { text = "" } { text = text $0 "\n" } /^\[  FAILED  \].* ms\)$/ { printf "%s", text }' "$log" >failures
  grep -qE '^\[==========\].* ran\.' "$log" || tail -n 20 "$log" >>failures
  if [ -s failures ]; then
    say
    say "### $(basename "$log" .log)"
    say
    say '```'
    cut -c1-400 failures | head -n 200 | tee -a "$figures"
    say '```'
  fi
done

say
say "## Frames, stages and errors"
# compare SCENE OPTIONS...: the command, and the table that it prints.
compare() {
  say
  say '```'
  say "\$ airlight compare $*"
  (cd "$pack" && timeout "$limit" airlight compare "$@" --quiet -o "$work/compare" 2>&1) >table
  code=$?
  tee -a "$figures" <table
  [ "$code" -eq 0 ] || { status=1; say "exit $code"; }
  say '```'
  rm -rf "$work/compare"
}
volumes=vsv,vsv:scan=column,vsv:scan=multi-pass,vsv:integral=riemann,vsv:integral=factored
volumes=$volumes,vsv:populate=conservative,vsv:populate=screen-space
for size in $sizes; do
  common="--size ${size}x$size --frames 5 --volume $volumes"
  # shellcheck disable=SC2086  # several words
  {
    compare window $common,reference-march
    compare toroid $common
    [ ! -f "$pack/scenes/victorian_fence_19k.glb" ] ||
      compare scenes/victorian_fence_19k.glb --eye 0.3,0.5,3 --target 0,0.4,0 --fov 45 --light-position=-0.2,0.7,-1 \
        --intensity 8 --sigma-s 0.25 $common
    [ ! -f "$pack/scenes/cornell_box_36.glb" ] ||
      compare scenes/cornell_box_36.glb --light-position 0,1.5,0 --intensity 5 --sigma-s 0.2 $common
    [ ! -f "$pack/scenes/sponza_262k.glb" ] ||
      compare scenes/sponza_262k.glb --eye=-12,3,-0.5 --target 0,5,0 --fov 60 --light-position 3,7,0 --intensity 300 \
        --sigma-s 0.04 --sigma-a 0.01 $common
    # A sun, a layer's integral by quadrature, and several lamps.
    compare window --sun=-4,7,-20 --irradiance 30 $common
    compare window --fog-top 4 --size "${size}x$size" --frames 5
    compare window --size "${size}x$size" --frames 5 --light-position=-4.5,13,-20 --intensity 15000 \
      --light-position=-6,13,-20 --intensity 15000 --light-position=-7.5,13,-20 --intensity 15000
  }
done
# Exact surface shadows beside the others, and an empty frame, whose cost every method shares.
surfaces=psv,psv:wedge=off,psv:order=file,shadow-map,vsv,none
compare window --size 1024x1024 --volume none --surface $surfaces
[ ! -f "$pack/scenes/victorian_fence_19k.glb" ] ||
  compare scenes/victorian_fence_19k.glb --eye 0.3,0.5,3 --target 0,0.4,0 --fov 45 --light-position=-0.2,0.7,-1 \
    --intensity 8 --sigma-s 0.25 --size 1024x1024 --volume none --surface $surfaces
[ ! -f "$pack/scenes/sponza_262k.glb" ] ||
  compare scenes/sponza_262k.glb --eye=-12,3,-0.5 --target 0,5,0 --fov 60 --light-position 3,7,0 --intensity 300 \
    --sigma-s 0.04 --sigma-a 0.01 --size 1024x1024 --volume none --surface $surfaces

say
say "## Exact surface shadows, judged"
say
say '```'
models="window toroid"
for model in sponza_262k maple_198k victorian_fence_19k dragon_nonmanifold_202k lily_duplicates_168k \
  willow_garage_backtoback_14k railing_degenerate_11k nonmanifold_1k terrain_1280k bunny_closed_144k bunny_holes_69k; do
  [ ! -f "$pack/scenes/$model.glb" ] || models="$models $pack/scenes/$model.glb"
done
# shellcheck disable=SC2086  # several words
timeout "$limit" airlight_exact $models 2>&1 | tee -a "$figures"
say '```'

say
say "## Functions"
say
say '```'
timeout "$limit" stdbuf -oL airlight_tables >table 2>&1
code=$?
tee -a "$figures" <table
[ "$code" -eq 0 ] || { status=1; say "exit $code"; }
say '```'
exit $status
