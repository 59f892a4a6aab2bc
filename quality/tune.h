#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quality/sweep.h"

namespace airlight::quality {

/// What a scene needs is the least that reaches a goal.
struct TuneGoal {
  enum class Kind {
    error,  ///< the least time whose same-surface rrmse is not above the limit
    ms,     ///< the least error whose frame takes not more than it
    bytes,  ///< the least error whose memory is not more than it
  };
  Kind kind;
  double limit;
};

struct TuneRequest {
  const Subject& subject;
  std::vector<Setting> settings;  ///< to choose from, all of one way of surface shadow
  TuneGoal goal;
  int rounds;  ///< frames timed of those that are nearly the best
  bool explains;
  Progress progress;  ///< may be empty
};

/// A setting, measured.
struct TunedSetting {
  Setting setting;
  /// Same-surface rrmse: over the pixels that settings are chosen by, and over others, which tell how far
  /// that is to be trusted.
  double chosen_error = 0.0, error = 0.0;
  double frame_ms = 0.0;
  std::int64_t bytes = 0;  ///< of GPU memory, its methods' and what they share
};

struct Tuned {
  /// The best that meets the goal on both sets of pixels; without one, what comes nearest to it.
  TunedSetting best;
  bool is_met = false;
  /// How sure it is that the goal is met over all pixels: of a thousand sets of tiles, drawn with repetition
  /// from those that were not chosen by, or of timed frames, the part in which it is. 1 for memory.
  double confidence = 0.0;
  std::size_t settings = 0;  ///< that were tried
  double truth_share = 0.0;  ///< of the pixels of the views that were looked at, those whose truth was traced
  std::size_t views = 0, frames = 0;  ///< views that were looked at; frames drawn

  /// What changing one knob of the best does.
  struct Knob {
    std::string name, from, to;
    double error_ratio, ms_ratio;  ///< what then is, over the best's
  };
  std::vector<Knob> knobs;
};

/// Finds the setting with few pixels of truth and few frames.
///
/// The truth is traced in tiles of 8 × 8 pixels, about a fiftieth of the image for choosing and as many for
/// judging, which are drawn where images of some settings differ most: an error that is estimated from tiles
/// drawn with a known probability, each divided by it, is that of the whole image on average (Hansen and
/// Hurwitz, "On the Theory of Sampling from Finite Populations", Annals of Mathematical Statistics 14, 1943).
/// Each setting is drawn twice; those that reach the goal and are nearly as good as the best are then timed
/// in rounds. Of a path settings are chosen by up to three views and judged by those between them.
/// @throws scene::Error as the methods do
Tuned tune(gpu::Context& context, const TuneRequest& request);

}  // namespace airlight::quality
