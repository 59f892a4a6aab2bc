#pragma once

#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "gpu/context.h"

namespace airlight::tests {

/// Makes the GL context of this test program before its first test, and ends it before main() does: a driver
/// whose threads still work while static objects are destroyed, its own among them, may crash or hang.
class ContextEnvironment : public testing::Environment {
 public:
  /// @throws std::runtime_error where the context is not on the driver that AIRLIGHT_RENDERER asks for by a
  /// part of its name
  void SetUp() override {
    context = std::make_unique<gpu::Context>(gpu::DebugOutput::synchronous);
    const char* asked = std::getenv("AIRLIGHT_RENDERER");
    const std::string& renderer = context->device().renderer;
    if (asked && renderer.find(asked) == std::string::npos)
      throw std::runtime_error("the renderer is " + renderer + ", not " + asked);
  }
  void TearDown() override { context.reset(); }
  std::unique_ptr<gpu::Context> context;
};

inline auto* const context_environment =
    static_cast<ContextEnvironment*>(testing::AddGlobalTestEnvironment(new ContextEnvironment));

inline gpu::Context& gpu_context() {
  return *context_environment->context;
}

}  // namespace airlight::tests
