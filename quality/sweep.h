#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quality/methods.h"
#include "quality/results.h"
#include "quality/run_file.h"
#include "quality/statistics.h"

namespace airlight::quality {

/// What one run of a sweep is told.
struct Setting {
  VolumeChoice volume;  ///< fitted to the views
  SurfaceChoice surface;
  std::optional<int> shadow_map;  ///< side of a cube face [texels]; none where neither method reads it
};

/// What is swept over: a scene and views of it.
struct Subject {
  std::string hash;  ///< of geometry and views, the same on every machine
  std::string scene_name;
  const scene::Scene& scene;
  std::span<const scene::View> views;
  bool is_path;
};

std::string hash_of_subject(const scene::Geometry& geometry, std::span<const scene::View> views);

/// What a run is found again by: a hash of the subject's hash, the methods' names and all of their options,
/// and the shadow map's size.
std::string key_of(const std::string& subject_hash, const Setting& setting);

/// A frame's time beside that of the baseline, of whole frames drawn next to each other.
struct PairedTime {
  int rounds = 0;
  /// time / baseline's time; over all views, and over those with odd and with even numbers
  MedianInterval ratio, odd_ratio, even_ratio;
  double ms = 0.0, cpu_ms = 0.0, baseline_ms = 0.0;  ///< medians, means over the views
  std::vector<double> view_ms;                       ///< medians, of each view
};

/// The times of rounds, each a frame of every view.
/// @param times, baseline of each round: of each view
PairedTime paired_time(std::span<const std::vector<double>> times,
                       std::span<const std::vector<double>> baseline, std::span<const double> cpu_ms);

struct SweepRequest {
  const Subject& subject;
  std::vector<Setting> settings;
  Setting baseline;
  int rounds;
  std::filesystem::path cache;  ///< where the truth is kept
  /// What repeats one of them, but -o.
  std::function<std::string(const Setting&)> command;
  Progress progress;  ///< may be empty; told how long is left
};

struct SweepCount {
  std::size_t measured = 0, found = 0;
};

/// Settings without those of the same key as one before, and without those of other shards.
std::vector<Setting> distinct_settings(const std::string& subject_hash, std::vector<Setting> settings,
                                       const Shard& shard);

/// Measures and judges each setting that the file does not have, and appends it.
///
/// They are taken in groups of up to 8, in the order of their keys, which is none. Of a group each setting's
/// errors, stages and memory are found first, as by `judged_run`. Then the group's frames are timed in
/// rounds, each in another order, drawn by a fixed seed: a frame of the setting and one of the baseline,
/// whichever comes first; along a path a play of it. The lines are appended when all rounds are done, so a
/// kill loses a group at most. A setting whose frames take more than 2 s is timed once.
/// @throws scene::Error as the methods do; (driver) before the truth is traced, where the driver cannot draw
/// what is asked for
SweepCount sweep(gpu::Context& context, RunFile& file, const SweepRequest& request);

}  // namespace airlight::quality
