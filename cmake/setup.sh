# What ./run and ./test share. Sourced from the root of the checkout.

build_packages=(
  ca-certificates ccache cmake g++ glslang-tools libcli11-dev libegl-dev libegl1 libembree-dev libepoxy-dev libfmt-dev
  libgl1-mesa-dri libglm-dev libopenexr-dev libpng-dev libtinygltf-dev libtinyobjloader-dev
  libtomlplusplus-dev ninja-build nlohmann-json3-dev pkg-config)
test_packages=(libgmock-dev libgtest-dev)

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

# build PRESET TARGET: configures once, builds what changed, and says so only where there is something to do.
build() {
  [ -f "build/$1/build.ninja" ] || { echo "Configuring build/$1" >&2; cmake --preset "$1" >/dev/null; }
  # Progress lines become one, and there is none where nothing is built.
  ninja -C "build/$1" "$2" 2>&1 | awk -v preset="build/$1" '
    /^\[/ { reconfigures = /Re-(checking|running)/; if (!reconfigures && !said++) print "Building " preset; next }
    /^CMake Error/ { reconfigures = 0 }
    reconfigures || /^ninja: (Entering|no work)/ { next }
    { print }' >&2
  [ "${PIPESTATUS[0]}" -eq 0 ]
}
