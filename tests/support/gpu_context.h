#pragma once

#include "gpu/context.h"

namespace airlight::tests {

/// The GL context of this test program: made once, by whoever asks first.
inline gpu::Context& gpu_context() {
  static gpu::Context context(gpu::DebugOutput::synchronous);
  return context;
}

}  // namespace airlight::tests
