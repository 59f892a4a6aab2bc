#pragma once

#include <chrono>
#include <map>
#include <string>

#include "gpu/context.h"

namespace airlight::gpu {

/// Wall-clock time of the stages of a frame.
///
/// Where stages are timed, the GPU is finished at both ends of each, so that a stage's time is its own: a
/// software driver bins and defers its draws, and its timestamp queries do not see that. This costs a GPU its
/// overlap between stages, so whole frames are timed with a timer that is off.
class StageTimer {
 public:
  /// @param context finished around each stage; nullptr turns the timer off
  explicit StageTimer(Context* context) : context_(context) {}

  /// Runs `stage` and adds its milliseconds to those of `name`.
  template <typename Function>
  void time(const std::string& name, Function&& stage) {
    if (!context_) {
      stage();
      return;
    }
    const auto start = begin();
    stage();
    end(name, start);
  }

  const std::map<std::string, double>& milliseconds() const { return milliseconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin();
  void end(const std::string& name, Clock::time_point start);

  Context* context_;
  std::map<std::string, double> milliseconds_;
};

}  // namespace airlight::gpu
