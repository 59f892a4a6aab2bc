#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "gpu/handle.h"

namespace airlight::gpu {

void delete_query(unsigned name);

/// Who tells a StageTimer the time.
enum class StageClock {
  /// Timestamps that the GPU takes as it gets there: nothing is held up.
  gpu,
  /// The CPU, with the GPU finished at both ends of each stage: right for a software driver, which bins and
  /// defers its draws, so that its timestamps do not see them; costs a GPU its overlap between stages.
  wall,
};

/// The clock that is right for a device.
StageClock stage_clock(const Device& device);

/// Time of the stages of a frame, which may nest: what an inner stage takes is its own, and not the outer's.
///
/// Of no more use after a stage has thrown.
class StageTimer {
 public:
  /// With the clock that is right for the context's device.
  /// @param context nullptr turns the timer off: stages are run, and nothing else
  explicit StageTimer(Context* context);
  StageTimer(Context& context, StageClock clock) : context_(&context), clock_(clock) {}

  /// Runs `stage` and adds its time to that of `name`.
  template <typename Function>
  void time(const std::string& name, Function&& stage) {
    begin(name);
    stage();
    end();
  }

  /// What runs from now on is of this part of the frame, or of none.
  void begin_part(std::optional<std::size_t> part) { part_ = part; }

  /// Of each stage that has run [ms], in one part of the frame or in all of it. Waits for the GPU to have got
  /// so far. No stage is running.
  std::map<std::string, double> milliseconds(std::optional<std::size_t> part = {}) const;

 private:
  using Clock = std::chrono::steady_clock;

  /// A moment, and which stage the time after it belongs to; "" for none.
  struct Mark {
    std::string stage;
    std::optional<std::size_t> part;
    Clock::time_point wall;
    Handle<delete_query> query;
  };

  void begin(const std::string& name);
  void end();
  void mark();
  double milliseconds_between(const Mark& from, const Mark& to) const;

  Context* context_;
  StageClock clock_ = StageClock::wall;
  std::vector<std::string> running_;  ///< innermost last
  std::optional<std::size_t> part_;
  std::vector<Mark> marks_;
};

}  // namespace airlight::gpu
