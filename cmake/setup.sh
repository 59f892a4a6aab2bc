# What ./run and ./test share. Sourced from the root of the checkout.

build_packages=(
  ca-certificates ccache cmake g++ glslang-tools libcli11-dev libegl-dev libegl1 libeigen3-dev libembree-dev libepoxy-dev
  libfmt-dev libgl1-mesa-dri libglfw3-dev libglm-dev libimgui-dev libjpeg62-turbo-dev libopenexr-dev libpng-dev libtinygltf-dev
  libtinyobjloader-dev
  libtomlplusplus-dev ninja-build nlohmann-json3-dev pkg-config zlib1g-dev)
test_packages=(chromium libgmock-dev libgtest-dev mesa-vulkan-drivers openbox xdotool xvfb)

# Installs the Debian packages that are missing; without root, says which those are.
install_packages() {
  local missing=()
  local package
  for package in "$@"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    echo "These packages are missing; please install them: apt-get install ${missing[*]}" >&2
    exit 3
  fi
  echo "Installing ${missing[*]}" >&2
  apt-get update -qq >&2
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
}

# build PRESET airlight|all: the program alone, or with its tests. Configures where there is no build yet, or one without the
# tests asked for (a build that has tests keeps them), builds what changed, and says so only where there is something to do.
build() {
  local tests=OFF known="^build $2:" cached=.
  if [ "$2" = all ]; then tests=ON known="^build tests/all:" cached="^AIRLIGHT_TESTS:BOOL=ON"; fi
  # Configuring can have failed half-way: the cache is written then, build.ninja is not.
  if ! grep -qs "$known" "build/$1/build.ninja" || ! grep -qs "$cached" "build/$1/CMakeCache.txt"; then
    echo "Configuring build/$1" >&2
    cmake --preset "$1" -D AIRLIGHT_TESTS=$tests >/dev/null
  fi
  # Progress lines become one, and there is none where nothing is built.
  ninja -C "build/$1" "$2" 2>&1 | awk -v preset="build/$1" '
    /^\[/ { reconfigures = /Re-(checking|running)/; if (!reconfigures && !said++) print "Building " preset; next }
    /^CMake Error/ { reconfigures = 0 }
    reconfigures || /^ninja: (Entering|no work)/ { next }
    { print }' >&2
  [ "${PIPESTATUS[0]}" -eq 0 ]
}
