# Sourced by the pack's launch and measure.sh, $pack being its folder: exports AIRLIGHT_LOADER and AIRLIGHT_LIBRARIES, with
# which every program of the pack is started, and points OpenGL's front end to a driver that it would not find.

# newer A B: whether version A is newer than B.
newer() { [ "$1" != "$2" ] && [ "$(printf '%s\n%s\n' "$1" "$2" | sort -V | tail -n 1)" = "$1" ]; }
# of_machine NAME: the machine's library of that name, for this processor.
of_machine() {
  PATH=$PATH:/usr/sbin:/sbin ldconfig -p 2>/dev/null | awk -v name="$1" '$1 == name && /x86-64|AArch64/ { print $NF; exit }'
}
# c++_version FILE: what a C++ library offers.
cxx_version() { grep -ao 'GLIBCXX_3\.4\.[0-9]*' "$1" 2>/dev/null | sort -V | tail -n 1; }

AIRLIGHT_LIBRARIES=$pack/lib
# The C library: the newer one.
if newer "$(cat "$pack/lib/c/version")" "$(getconf GNU_LIBC_VERSION 2>/dev/null)"; then
  AIRLIGHT_LOADER=$pack/lib/c/loader
  AIRLIGHT_LIBRARIES=$AIRLIGHT_LIBRARIES:$pack/lib/c
else
  AIRLIGHT_LOADER=$(cat "$pack/lib/c/machine_loader")
fi
# The C++ library: the newer one.
if newer "$(cxx_version "$pack/lib/c++/libstdc++.so.6")" "$(cxx_version "$(of_machine libstdc++.so.6)")"; then
  AIRLIGHT_LIBRARIES=$AIRLIGHT_LIBRARIES:$pack/lib/c++
fi
[ -n "$(of_machine libz.so.1)" ] || AIRLIGHT_LIBRARIES=$AIRLIGHT_LIBRARIES:$pack/lib/z
# OpenGL's front end: the machine's if it is whole.
if [ -z "$(of_machine libEGL.so.1)" ] || [ -z "$(of_machine libOpenGL.so.0)" ]; then
  AIRLIGHT_LIBRARIES=$AIRLIGHT_LIBRARIES:$pack/lib/gl
fi
# The loader looks here instead of LD_LIBRARY_PATH, and a driver may lie where only that says.
AIRLIGHT_LIBRARIES=$AIRLIGHT_LIBRARIES${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
for folder in /usr/local/nvidia/lib64 /usr/local/nvidia/lib; do
  [ ! -d "$folder" ] || AIRLIGHT_LIBRARIES=$AIRLIGHT_LIBRARIES:$folder
done
export AIRLIGHT_LOADER AIRLIGHT_LIBRARIES

# An NVIDIA driver that no file announces to the front end, as containers have it.
if [ -z "${__EGL_VENDOR_LIBRARY_FILENAMES:-}${__EGL_VENDOR_LIBRARY_DIRS:-}" ] &&
  ! cat /etc/glvnd/egl_vendor.d/*.json /usr/share/glvnd/egl_vendor.d/*.json 2>/dev/null | grep -q nvidia; then
  if [ -n "$(of_machine libEGL_nvidia.so.0)" ] || [ -e /usr/local/nvidia/lib64/libEGL_nvidia.so.0 ]; then
    export __EGL_VENDOR_LIBRARY_FILENAMES="$pack/lib/gl/nvidia.json"
  fi
fi
