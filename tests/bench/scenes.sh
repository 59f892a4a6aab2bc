#!/usr/bin/env bash
# The figures of README.md and docs/figures.md:
# `tests/bench/scenes.sh truth|accuracy|speed|sun|sun-speed|sun-curves|far|quadrature|lights|curves|cost|leaks|causes|path|rivals|rows|flicker|bits-or-tree|trees|surfaces|charts|tuned [OUT]`.
# The paper's Tables 2 to 4 and the bandwidth: build/release/tests/bench/airlight_tables, after ./test.
#
# truth     the exact reference against itself refined, against rays, 256×256 and 512×512 pixels
# accuracy  512×512 pixels, the default grid, against the reference
# speed     1024×1024 pixels, a shadow cube of 1024², against 512 shadow rays a pixel
# sun       five views by a sun, 512×512: the default cells, equal ones, one range of φ for all half-planes, and the populations
# sun-speed the same at 1024×1024, a shadow map of 2048², against 512 shadow rays a pixel
# sun-curves  the error as each count of the grid and the shadow map doubles
# far       lamps 10² to 10⁵ m from the eye through the window, 512×512: fog as thin as lets their light arrive
# lights    1, 2, 4 and 8 lamps that share the power of one, 512×512: time, error and the stages of each
# quadrature  table, quadrature and riemann, 512×512 and 1024×1024, with a texture, and under a lamp above a layer
# curves    the error as each count of the grid doubles, the others at their defaults
# cost      every population × integral × ranges, 1024×1024 pixels: time, error and stages (the paper's Table 1)
# leaks     the three populations on closed and open models, 512×512 pixels
# causes    the error of a fine grid, and what it becomes as one thing at a time is at its default
# rivals    vsv and what engines use instead, each at several costs, 1024×1024: sweeps, and what leads at which error
# rows          march by look-ups of the shadow map and of rows of light rays, 1024×1024: sweeps
# flicker       vsv and its rivals along three paths, 512×512: sweeps, and what leads at which error and flicker
# bits-or-tree  vsv by bits and by the tree, over the counts of φ, 512×512: a sweep each
# trees         tree-march against march and vsv, 512×512, and in coloured light, 256×144: sweeps
# surfaces      every surface method, 512×512: time, bytes, wrong and undecided pixels
# charts        every method at 68 settings in all, 512×512, five scenes: sweeps, and a page each
# tuned         `airlight tune` against sweeps of the same 66 settings: those of charts, and five scenes more, 256×256
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
  [arboretum]="$scenes/arboretum_1644k.glb --eye=-8,3,34 --target 13,5,10 --fov 55 --light-position 18,9,2
    --intensity 1500 --sigma-s 0.03"
  [toroid]=toroid
  [chapel]=chapel
  [bunny_closed]="$scenes/bunny_closed_144k.glb --sigma-s 0.3 --intensity 5 --eye 0.3,1.2,3.2 --target 0,0.8,0 --fov 45
    --light-position=-0.7,1.7,-1.2"
  [lucy]="$scenes/lucy_100k.glb --sigma-s 0.3 --intensity 5 --eye 0.7,0.4,2.6 --target 0.7,0.2,0 --fov 50
    --light-position=0.45,0.9,-0.5"
  [staircase]="$scenes/spiral_staircase_15k.glb --eye 2.2,2.2,3.2 --target 0,1.6,0 --fov 50 --light-position=-0.5,3.2,-1.2
    --intensity 20 --sigma-s 0.2"
  [house]="$scenes/small_house_146k.glb --eye 8,1.6,4 --target=-2,1.3,0 --fov 65 --light-position 0,2.6,0 --intensity 60
    --sigma-s 0.06"
  [sun_sponza]="$scenes/sponza_262k.glb --eye=-12,3,-0.5 --target 0,5,0 --fov 60 --sun 0.35,1,0.15 --irradiance 10
    --fog-top 16 --sigma-s 0.04 --sigma-a 0.01"
  [sun_court]="$scenes/sponza_262k.glb --eye=-10,2,0.5 --target 0,6,0 --fov 60 --sun 0.9,0.6,0.05 --irradiance 10
    --sigma-s 0.04"
  [sun_fence]="$scenes/victorian_fence_19k.glb --eye 0.3,0.5,3 --target 0,0.4,0 --fov 45 --sun=-0.1,0.3,-1 --irradiance 10
    --fog-top 4 --sigma-s 0.25"
  [sun_maple]="$scenes/maple_198k.glb --eye=-2,2,11 --target 0.5,3.8,0 --fov 50 --sun 0.35,0.45,-1 --irradiance 10
    --fog-top 12 --sigma-s 0.06 --phase henyey-greenstein --g 0.5"
  [sun_window]="window --sun=-4,7,-20 --irradiance 30"
  [nave]=nave
)
suns="sun_sponza sun_court sun_fence sun_maple sun_window nave"
compare() { # SCENE OPTIONS...
  local scene=$1
  shift
  # shellcheck disable=SC2086  # a view is several words
  ./run compare ${view[$scene]} --cache "$out/truth" "$@"
  echo
}
sweep() { # SCENE OPTIONS...
  local scene=$1
  shift
  # shellcheck disable=SC2086
  ./run sweep ${view[$scene]} --cache "$out/truth" "$@"
}
# What a user might choose from, the paper's grid among it.
every_setting='vsv:alpha={128,256}:theta={512,1024,2048}:phi={128,256,512,1024},vsv:alpha=512:theta=2048:phi=512'
every_setting+=',vsv:where={half,quarter,epipolar}:phi={256,512},vsv:query=tree:phi={256,512,1024,2048}'
every_setting+=',vsv:integral={riemann,quadrature,factored},vsv:populate={conservative,screen-space}'
every_setting+=',march:steps={8,16,32,64,128,256}:jitter={off,gathered},march:where={half,quarter,epipolar}:steps={32,128}'
every_setting+=',march:steps={32,128}:spacing=angle:look-up=rows,froxel:tile={4,8,16}:samples={1,4}'
march=reference-march:rays=single,reference-march:rays=packet
case ${1:-} in
  truth)
    for size in 256x256 512x512; do
      for scene in window fence sponza maple toroid arboretum; do
        compare "$scene" --size $size --surface none --frames 1 -o "$out/truth_${size}_$scene" --quiet \
          --volume "reference:refine=4,reference-sampled:samples=512,reference-sampled:samples=2048,reference-march"
      done
    done
    ;;
  accuracy)
    for scene in window fence sponza maple; do
      compare "$scene" --size 512x512 -o "$out/accuracy_$scene" \
        --volume vsv,vsv:integral=riemann,vsv:phi-cells=equal --quiet
    done
    ;;
  speed)
    for scene in window sponza maple; do
      compare "$scene" --size 1024x1024 --shadow-map 1024 -o "$out/speed_$scene" \
        --volume "vsv,vsv:scan=column,vsv:integral=riemann,$march" --quiet
    done
    ;;
  sun)
    for scene in $suns; do
      compare "$scene" --size 512x512 -o "$out/sun_$scene" --frames 1 --quiet \
        --volume "vsv,vsv:phi-cells=equal,vsv:ranges=alpha-phi,vsv:populate=conservative,vsv:populate=screen-space,vsv:integral=riemann,vsv:integral=factored"
    done
    ;;
  sun-speed)
    for scene in $suns; do
      compare "$scene" --size 1024x1024 -o "$out/sun_speed_$scene" --quiet \
        --volume "vsv,vsv:integral=riemann,vsv:populate=conservative,$march"
    done
    ;;
  sun-curves)
    grids=vsv
    for n in 64 128 512; do grids+=,vsv:alpha=$n; done
    for n in 256 512 2048 4096; do grids+=,vsv:theta=$n; done
    for n in 128 256 1024 2048; do grids+=,vsv:phi=$n; done
    for scene in sun_sponza sun_window nave; do
      compare "$scene" --size 512x512 -o "$out/sun_curves_$scene" --volume "$grids" --frames 1 --quiet
      for n in 1024 4096 8192; do
        compare "$scene" --size 512x512 --shadow-map $n -o "$out/sun_map_${n}_$scene" --volume vsv --frames 1 --quiet
      done
    done
    ;;
  far)
    for distance in 100 1000 10000 100000; do
      # Towards the light from the eye of `window`, (0, 1.7, 9).
      view[far]="window $(awk -v d=$distance 'BEGIN { n = sqrt(4.5 * 4.5 + 11 * 11 + 25 * 25); printf \
        "--light-position=%.9g,%.9g,%.9g --intensity %g --sigma-s %g", -4.5 * d / n, 1.7 + 11 * d / n, 9 - 25 * d / n,
        10 * d * d, 1 / d }')"
      compare far --size 512x512 -o "$out/far_$distance" --volume vsv --frames 1 --quiet
    done
    ;;
  lights)
    for n in 1 2 4 8; do
      # From the view's own lamp on, a metre and a half apart.
      lamps() { # X Y,Z WATTS_PER_SR
        awk -v n=$n -v x="$1" -v rest="$2" -v power="$3" 'BEGIN { for (i = 0; i < n; ++i)
          printf " --light-position=%g,%s --intensity %g", x - 1.5 * i, rest, power / n }'
      }
      view[lights_window]="window $(lamps -4.5 13,-20 43000)"
      view[lights_sponza]="$scenes/sponza_262k.glb --eye=-12,3,-0.5 --target 0,5,0 --fov 60 --sigma-s 0.04 --sigma-a 0.01
        $(lamps 3 7,0 300)"
      for scene in lights_window lights_sponza; do
        compare $scene --size 512x512 -o "$out/${scene}_$n" --volume vsv --frames 9 --quiet
      done
    done
    ;;
  quadrature)
    integrals=vsv:integral=quadrature,vsv:integral=riemann
    ./run render cornell --size 512x256 -o "$out/texture.exr" --quiet
    view[layer]="window --fog-top 4"
    for size in 512x512 1024x1024; do
      for scene in window fence maple; do
        compare "$scene" --size $size --surface none -o "$out/quadrature_${size}_$scene" --frames 3 --quiet \
          --volume "vsv:integral=table,$integrals"
        compare "$scene" --size $size --surface none -o "$out/quadrature_${size}_textured_$scene" --frames 1 --quiet \
          --light-texture "$out/texture.exr" --volume "$integrals"
      done
      compare layer --size $size --surface none -o "$out/quadrature_${size}_layer" --frames 3 --quiet --volume "$integrals"
    done
    ;;
  curves)
    grids=vsv
    for n in 64 128 256; do grids+=,vsv:alpha=$n; done
    for n in 64 128 256 512 2048; do grids+=,vsv:theta=$n; done
    for n in 128 256 1024; do grids+=,vsv:phi=$n; done
    compare window --size 512x512 -o "$out/curves_window" --volume "$grids" --frames 1 --quiet
    compare sponza --size 512x512 -o "$out/curves_sponza" --volume "$grids" --frames 1 --quiet
    ;;
  cost)
    volumes=
    for populate in shadow-map conservative screen-space; do
      for integral in table factored riemann; do
        for ranges in frame alpha-phi full; do
          volumes+=${volumes:+,}vsv:populate=$populate:integral=$integral:ranges=$ranges
        done
      done
    done
    volumes+=,vsv:theta-cells=equal:phi-cells=equal:scan=multi-pass:ranges=alpha-phi:integral=riemann # all as in the paper
    for scene in window fence sponza maple; do
      compare "$scene" --size 1024x1024 --shadow-map 2048 -o "$out/cost_$scene" --frames 2 \
        --volume "$volumes" --quiet
    done
    ;;
  leaks)
    volumes=vsv,vsv:populate=conservative,vsv:populate=screen-space
    volumes+=,vsv:populate=screen-space:alpha=2048,vsv:populate=conservative:alpha=1024:theta=4096:phi=1024
    view[bunny_holes]="${view[bunny_closed]/bunny_closed_144k/bunny_holes_69k}"
    view[toroid_hole]=assets/toroid_hole.toml
    for scene in toroid toroid_hole bunny_closed lucy bunny_holes sponza; do
      compare "$scene" --size 512x512 --shadow-map 2048 -o "$out/leaks_$scene" --frames 1 \
        --volume "$volumes" --quiet
    done
    ;;
  causes)
    fine=vsv:alpha=1024:theta=8192:phi=1024
    for scene in window fence sponza maple; do
      compare "$scene" --size 512x512 --shadow-map 4096 -o "$out/causes_$scene" --frames 1 --quiet \
        --volume "$fine,vsv:alpha=512:theta=8192:phi=1024,vsv:alpha=1024:theta=1024:phi=1024,vsv:alpha=1024:theta=8192:phi=512,$fine:integral=riemann,$fine:integral=factored"
      compare "$scene" --size 512x512 --shadow-map 2048 -o "$out/causes_shadow_map_$scene" --frames 1 \
        --volume "$fine" --quiet
    done
    ;;
  path)
    for scene in window sponza; do
      compare "$scene" --size 512x512 --shadow-map 2048 -o "$out/path_$scene" --frames 3 --quiet \
        --path tests/bench/rest_$scene.toml --volume vsv,vsv:ranges=full:theta-cells=equal
    done
    ;;
  rivals)
    settings='vsv:phi={256,512,1024},vsv:where=half:phi=256,vsv:where=epipolar:phi={256,512},vsv:query=tree:phi={512,2048}'
    settings+=',march:steps={16,64}:jitter={off,gathered},march:steps=256,march:where=epipolar:steps={64,256}'
    settings+=',froxel:tile={4,8},froxel:tile=8:samples=4'
    fine='vsv:phi=1024,vsv:alpha=512:theta=2048:phi=1024,march:steps=256'
    for scene in window sponza fence maple sun_sponza; do
      options=(--size 1024x1024 --surface none --frames 6 -o "$out/rivals_$scene" --quiet)
      sweep "$scene" "${options[@]}" --volume "$settings"
      sweep "$scene" "${options[@]}" --volume "$fine" --shadow-map 4096
      ./run front "$out/rivals_$scene"
    done
    ;;
  rows)
    for scene in window sponza fence maple sun_sponza; do
      sweep "$scene" --size 1024x1024 --surface none --frames 6 -o "$out/rows_$scene" --quiet \
        --volume 'march:steps={16,64}:spacing=angle:look-up={map,rows},march:where=epipolar:steps=64:look-up={map,rows}'
    done
    ;;
  flicker)
    settings='vsv:phi={256,512},vsv:where=epipolar:phi=256,vsv:query=tree,march:where=epipolar:steps=64,march:steps=64:jitter=gathered'
    settings+=',march:steps=64:look-up=rows,froxel:history={on,off}'
    declare -A path=([window]=assets/paths/window_walk.toml [sponza]=tests/bench/rest_sponza.toml [nave]=assets/paths/nave_evening.toml)
    for scene in window sponza nave; do
      sweep "$scene" --path "${path[$scene]}" --size 512x512 --surface none --frames 2 -o "$out/flicker_$scene" --quiet --volume "$settings"
      for error in rrmse flicker; do ./run front "$out/flicker_$scene" --error $error; done
    done
    ;;
  bits-or-tree)
    for scene in sponza window fence maple; do
      sweep "$scene" --size 512x512 --surface none --frames 6 -o "$out/bits_or_tree_$scene" --quiet \
        --volume 'vsv:query={bits,tree}:phi={128,512,1024,2048,4096}'
    done
    ;;
  trees)
    for scene in window sponza maple; do
      sweep "$scene" --size 512x512 --surface none --frames 2 -o "$out/trees_$scene" --quiet \
        --volume 'vsv:phi={256,512},vsv:where=epipolar:phi=256,march:where=epipolar:steps={16,64,256},tree-march:tree={psv,metric-tree}:where=epipolar:steps={16,64,256},march:steps=16,tree-march:tree={psv,metric-tree}:steps=16'
      ./run front "$out/trees_$scene"
    done
    sweep chapel --size 256x144 --surface none --frames 2 -o "$out/trees_chapel" --quiet \
      --volume 'tree-march:tree={psv,metric-tree}:where=epipolar:steps={16,64,256,512},tree-march:steps=64'
    ;;
  surfaces)
    for scene in window sponza fence maple toroid chapel; do
      compare "$scene" --size 512x512 -o "$out/surfaces_$scene" --volume none --frames 3 --quiet \
        --surface shadow-map,psv,psv:cull=auto,metric-tree,metric-tree:cull=auto,reference
    done
    ;;
  charts)
    for scene in window sponza fence maple sun_sponza; do
      sweep "$scene" --size 512x512 --surface none --frames 6 -o "$out/chart_$scene" --quiet \
        --volume "$every_setting,tree-march:tree={psv,metric-tree}:where=epipolar:steps=16"
      ./run front "$out/chart_$scene"
      ./run report "$out/chart_$scene" -o "$out/chart_$scene.html"
    done
    ;;
  tuned)
    tuned() { # SCENE SIZE FOLDER ROUNDS
      sweep "$1" --size "$2" --surface none --frames "$4" -o "$3" --quiet --volume "$every_setting"
      for error in 0.02 0.01; do
        # shellcheck disable=SC2086
        ./run tune ${view[$1]} --size "$2" --surface none --shadow-map 2048 --volume "$every_setting" --quiet \
          --max-error $error --json "$3/$error.json" >/dev/null || true
      done
      tests/bench/tuned.py "$3"
    }
    for scene in window fence maple sun_sponza sponza; do tuned $scene 512x512 "$out/chart_$scene" 6; done
    for scene in staircase house lucy bunny_closed arboretum; do tuned $scene 256x256 "$out/tuned_$scene" 3; done
    ;;
  *)
    echo "usage: tests/bench/scenes.sh truth|accuracy|speed|sun|sun-speed|sun-curves|far|quadrature|lights|curves|cost|leaks|causes|path|rivals|rows|flicker|bits-or-tree|trees|surfaces|charts|tuned [OUT]" >&2
    exit 2
    ;;
esac
