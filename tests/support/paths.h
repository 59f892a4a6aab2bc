#pragma once

#include <cstdlib>
#include <filesystem>

namespace airlight::tests {

/// The path in that environment variable, by default `built`.
inline std::filesystem::path path(const char* variable, const char* built) {
  const char* given = std::getenv(variable);
  return given ? given : built;
}

}  // namespace airlight::tests

// What tests read: where the build found it, or, for a test program that was carried to another machine (see
// tests/device/pack.sh), where the environment variable of that name says.
#define AIRLIGHT_ASSETS airlight::tests::path("AIRLIGHT_ASSETS", AIRLIGHT_BUILT_ASSETS)
#define AIRLIGHT_BINARY airlight::tests::path("AIRLIGHT_BINARY", AIRLIGHT_BUILT_BINARY)
#define AIRLIGHT_EXPECTED_IMAGES \
  airlight::tests::path("AIRLIGHT_EXPECTED_IMAGES", AIRLIGHT_BUILT_EXPECTED_IMAGES)
#define AIRLIGHT_SCHEMA airlight::tests::path("AIRLIGHT_SCHEMA", AIRLIGHT_BUILT_SCHEMA)
#define AIRLIGHT_SHOT_HEADER airlight::tests::path("AIRLIGHT_SHOT_HEADER", AIRLIGHT_BUILT_SHOT_HEADER)
#define AIRLIGHT_README airlight::tests::path("AIRLIGHT_README", AIRLIGHT_BUILT_README)
