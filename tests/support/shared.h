#pragma once

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

namespace airlight::tests {

/// A file of the developers' shared data (real models, truth images), found through AIRLIGHT_SHARED, by
/// default the folder `shared` beside the checkout. It may not exist: see AIRLIGHT_NEEDS.
inline std::filesystem::path shared_file(const std::filesystem::path& name) {
  const char* folder = std::getenv("AIRLIGHT_SHARED");
  return std::filesystem::path(folder ? folder : AIRLIGHT_DEFAULT_SHARED) / name;
}

}  // namespace airlight::tests

/// Skips the test, saying why, where a shared file is missing.
#define AIRLIGHT_NEEDS(file)                                                                              \
  if (!std::filesystem::exists(file)) {                                                                   \
    GTEST_SKIP() << (file).string() << " is not there; set AIRLIGHT_SHARED to the folder of shared data"; \
  }                                                                                                       \
  static_assert(true)
