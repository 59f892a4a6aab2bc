#!/usr/bin/env bash
# The figures of README.md and docs/figures.md: `tests/bench/scenes.sh accuracy|speed|curves [OUT]`.
#
# accuracy  512×512 pixels, the default grid, against the converged reference
# speed     1024×1024 pixels, a shadow cube of 1024², against 512 shadow rays a pixel
# curves    the error as each count of the grid doubles, the others at their defaults
# The models are not part of the project: AIRLIGHT_SHARED is the folder that holds scenes/ (default ../shared).
set -euo pipefail
cd "$(dirname "$0")/../.."
scenes=${AIRLIGHT_SHARED:-../shared}/scenes
out=${2:-out}
declare -A view=(
  [window]="window"
  [fence]="$scenes/victorian_fence_19k.glb --eye 0.3,0.5,3 --target 0,0.4,0 --fov 45 --light-position=-0.2,0.7,-1
    --intensity 8 --sigma-s 0.25"
  [sponza]="$scenes/sponza_262k.glb --eye=-12,3,-0.5 --target 0,5,0 --fov 60 --light-position 3,7,0 --intensity 300
    --sigma-s 0.04 --sigma-a 0.01"
  [maple]="$scenes/maple_198k.glb --eye=-2,2,11 --target 0.5,3.8,0 --fov 50 --light-position 1.5,5,-5 --intensity 200
    --sigma-s 0.06 --phase henyey-greenstein --g 0.5"
)
compare() { # SCENE OPTIONS...
  local scene=$1
  shift
  # shellcheck disable=SC2086  # a view is several words
  ./run compare ${view[$scene]} "$@"
  echo
}
march=reference-march:rays=single,reference-march:rays=packet
case ${1:-} in
  accuracy)
    for scene in window fence sponza; do
      compare "$scene" --size 512x512 --reference-samples 1024 -o "$out/accuracy_$scene" \
        --volume vsv,vsv:integral=riemann,vsv:phi-cells=equal --quiet
    done
    # Foliage needs more samples before the reference stands still.
    compare maple --size 512x512 --reference-samples 2048 -o "$out/accuracy_maple" \
      --volume vsv,vsv:integral=riemann,vsv:phi-cells=equal --quiet
    ;;
  speed)
    for scene in window sponza maple; do
      compare "$scene" --size 1024x1024 --shadow-map 1024 --reference-samples 128 -o "$out/speed_$scene" \
        --volume "vsv,vsv:scan=fused,vsv:integral=riemann,$march" --quiet
    done
    ;;
  curves)
    grids=vsv
    for n in 64 128 256; do grids+=,vsv:alpha=$n; done
    for n in 64 128 256 512 1024; do grids+=,vsv:theta=$n; done
    for n in 128 256 1024; do grids+=,vsv:phi=$n; done
    compare window --size 512x512 --reference-samples 1024 -o "$out/curves_window" --volume "$grids" --frames 1 --quiet
    compare sponza --size 512x512 --reference-samples 1024 -o "$out/curves_sponza" --volume "$grids" --frames 1 --quiet
    ;;
  *)
    echo "usage: tests/bench/scenes.sh accuracy|speed|curves [OUT]" >&2
    exit 2
    ;;
esac
