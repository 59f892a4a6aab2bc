#!/usr/bin/env bash
# Packs what a machine with a GPU needs to test and measure Airlight in one call, without packages and without a network:
# `tests/device/pack.sh [FILE.tar.xz]` (default out/airlight-device.tar.xz), after ./test. There: unpack, run measure.sh.
#
# The machine brings its kernel, its OpenGL driver, a shell and coreutils; the pack brings the rest. Which C library runs is
# chosen there (libraries.sh): the machine's, or the pack's where that is newer, since each supports what was built with an
# older one, and the driver has to live in the same process.
#
# Scenes: the project's own, and of AIRLIGHT_SHARED (default ../shared), where it exists, the truth and the smaller models.
set -euo pipefail
cd "$(dirname "$0")/../.."
source cmake/setup.sh
out=${1:-out/airlight-device.tar.xz}
build=build/release
[ -x "$build/tests/gpu/gpu_test" ] || { echo "pack.sh: $build has no tests; run ./test first" >&2; exit 1; }
install_packages binutils libegl1 libglvnd0 libopengl0 xz-utils

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
pack=$work/airlight-device
mkdir -p "$pack"/{bin,programs,scenes,lib/c,lib/c++,lib/gl,lib/z}

# The programs. Each is started by a link of its name to bin/launch.
programs=("$build/airlight" "$build"/tests/bench/airlight_{tables,exact} "$build"/tests/{unit,gpu,image,cli}/*_test)
for program in "${programs[@]}"; do
  name=$(basename "$program")
  strip -o "$pack/programs/$name" "$program"
  ln -s launch "$pack/bin/$name"
done
cp tests/device/launch tests/device/libraries.sh "$pack/bin/"
cp tests/device/measure.sh "$pack/"

# What they read.
cp -r assets "$pack/assets"
cp -r tests/image/expected "$pack/expected"
cp docs/results.schema.json "$pack/"
shared=${AIRLIGHT_SHARED:-../shared}
if [ -d "$shared/scenes" ]; then
  # What is larger would be most of the pack.
  find "$shared/scenes" -type f -size -5M -exec cp {} "$pack/scenes/" \;
  [ ! -f "$shared/scenes/terrain_1280k.glb" ] || cp "$shared/scenes/terrain_1280k.glb" "$pack/scenes/"
  cp -r "$shared/truth" "$pack/"
else
  echo "pack.sh: without shared scenes: $shared/scenes is not there" >&2
fi

# Their libraries, in folders by what decides whether the machine's own serve instead.
libraries() { ldd "$@" | awk '$2 == "=>" { print $3 }' | sort -u; }
while read -r library; do
  case $(basename "$library") in
    libc.so.* | libm.so.* | libdl.so.* | libpthread.so.* | librt.so.* | libresolv.so.*) folder=c ;;
    libstdc++.so.* | libgcc_s.so.*) folder=c++ ;;
    libz.so.*) folder=z ;;
    *) folder=. ;;
  esac
  cp -L "$library" "$pack/lib/$folder/"
done < <(libraries "${programs[@]}")
# The C library's other parts, which a driver may ask for.
c_folder=$(dirname "$(libraries "$build/airlight" | grep '/libc\.so')")
cp -L "$c_folder"/lib{dl,pthread,rt,resolv}.so.[0-9] "$pack/lib/c/"
loader=$(readelf -l "$build/airlight" | sed -n 's/.*program interpreter: \(.*\)\]/\1/p')
cp -L "$loader" "$pack/lib/c/loader"
echo "$loader" >"$pack/lib/c/machine_loader"
getconf GNU_LIBC_VERSION >"$pack/lib/c/version"
# OpenGL's front end, which finds the driver.
for library in libEGL.so.1 libGLdispatch.so.0 libOpenGL.so.0; do
  cp -L "$(ldconfig -p | awk -v name="$library" '$1 == name { print $NF; exit }')" "$pack/lib/gl/"
done
echo '{"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_nvidia.so.0"}}' >"$pack/lib/gl/nvidia.json"

git describe --always --dirty >"$pack/commit"
mkdir -p "$(dirname "$out")"
tar -C "$work" -c airlight-device | xz -T0 -6 >"$out"
echo "$out: $(du -h "$out" | cut -f1); there: tar -xf $(basename "$out") && airlight-device/measure.sh"
