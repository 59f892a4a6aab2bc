# Sourced by what opens a report: `headless PROFILE ARGUMENTS...` is a Chromium without a window, which keeps what it needs in the
# folder PROFILE. $chromium is empty where there is none.
chromium=$(command -v chromium || command -v chromium-browser || true)
headless() {
  local profile=$1
  shift
  timeout 120 "$chromium" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run --disable-background-networking \
    --disable-component-update --hide-scrollbars --user-data-dir="$profile" "$@"
}
