#include "gpu/timer.h"

namespace airlight::gpu {

StageTimer::Clock::time_point StageTimer::begin() {
  context_->finish();
  return Clock::now();
}

void StageTimer::end(const std::string& name, Clock::time_point start) {
  context_->finish();
  milliseconds_[name] += std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace airlight::gpu
