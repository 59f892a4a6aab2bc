#!/usr/bin/env bash
# Runs a command on a second OpenGL driver: `tests/drivers/on_zink.sh build/release/airlight info`. The driver is zink, which
# turns OpenGL into Vulkan, on lavapipe, Mesa's Vulkan for the CPU. Where lavapipe is not installed: exit 77, and why.
set -euo pipefail
if ! compgen -G '/usr/share/vulkan/icd.d/lvp_icd.*.json' >/dev/null; then
  echo "zink: Skipped"
  echo "lavapipe is not installed (package mesa-vulkan-drivers)"
  exit 77
fi
# Vulkan's device selection wants a folder that is the user's alone.
runtime=$(mktemp -d)
trap 'rm -rf "$runtime"' EXIT
export MESA_LOADER_DRIVER_OVERRIDE=zink EGL_PLATFORM=surfaceless LIBGL_ALWAYS_SOFTWARE=1 XDG_RUNTIME_DIR=$runtime
# The tests refuse another driver than this.
export AIRLIGHT_RENDERER=zink
status=0
"$@" || status=$?
exit "$status"
