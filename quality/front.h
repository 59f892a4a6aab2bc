#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "quality/statistics.h"

namespace airlight::quality {

/// What says how far a run is from the truth.
struct FrontError {
  std::string_view name;
  std::string_view meaning;
  std::string_view column;       ///< of a run's "views"
  std::array<double, 6> levels;  ///< that a front is asked about
  double shown;                  ///< times this; 100 of what is shown in %
};
inline constexpr FrontError k_front_errors[] = {
    {"rrmse", "same-surface rrmse", "same_surface_rrmse", {0.0025, 0.005, 0.01, 0.02, 0.05, 0.1}, 100.0},
    {"p99", "99th percentile of the error over the mean", "p99", {0.01, 0.02, 0.05, 0.1, 0.2, 0.5}, 100.0},
    {"flip", "mean of HDR-FLIP", "flip", {0.005, 0.01, 0.02, 0.05, 0.1, 0.2}, 1.0},
    {"flicker", "flicker along the path", "flicker", {0.0025, 0.005, 0.01, 0.02, 0.05, 0.1}, 100.0}};

/// @throws scene::Error (usage) naming the words
const FrontError& parse_front_error(std::string_view name);

/// What there is to say of a run, over some of its views.
struct SweptRun {
  struct OverViews {
    double error;          ///< mean over the views; of dark ones none
    MedianInterval ratio;  ///< of its time to the baseline's
  };
  std::string key, volume, surface;
  std::string method;  ///< of airlight
  std::optional<int> shadow_map;
  std::int64_t bytes = 0;  ///< of GPU memory, its methods' and what they share
  double frame_ms = 0.0;   ///< over all views
  /// Settings are chosen by the first and judged by the second: views with odd and with even numbers, from 0.
  /// Of one view both are the same.
  OverViews chosen{}, judged{};
};

/// The best settings of one method for an error: the cheapest of those that are below it on the views that
/// settings are chosen by.
struct FrontEntry {
  SweptRun run;
  bool holds;  ///< whether it is below it on those that settings are judged by, too
};

/// One error.
struct FrontLevel {
  double error;
  std::vector<FrontEntry> methods;  ///< that reach it, those that hold first, the cheapest first

  /// The cheapest, where one holds.
  const SweptRun* best() const { return methods.empty() || !methods[0].holds ? nullptr : &methods[0].run; }
  /// The cheapest of the others that hold; nullptr where there is none.
  const SweptRun* rival() const {
    return methods.size() < 2 || !methods[1].holds ? nullptr : &methods[1].run;
  }
  /// The rival's time over the best's, on the views that settings are judged by. The interval is the quotient
  /// of theirs, which holds the true one at 90 % or more. NaN where there is no rival.
  MedianInterval lead() const;
  /// Whether that interval excludes 1.
  bool leads() const { return lead().low > 1.0; }
};

/// Runs that can be compared: of one subject, on one device, beside one baseline, with one way of surface
/// shadow.
struct Front {
  std::string scene, device, baseline, surface;
  int width = 0, height = 0;
  std::size_t views = 0, runs = 0;
  FrontError error = k_front_errors[0];
  std::vector<FrontLevel> levels;  ///< of the error
};

/// The fronts of all runs in folders that `airlight sweep` has written, and in .jsonl files. Of a key that is
/// there twice on one device the first run counts.
/// @throws scene::Error (bad_file) naming a folder without runs, and a line that is none
std::vector<Front> read_fronts(std::span<const std::filesystem::path> places,
                               const FrontError& error = k_front_errors[0]);

/// As JSON: {"airlight", "fronts": [{"scene", "size", "views", "device", "surface", "baseline", "runs",
/// "error", "levels": [{"error", "leads", "lead": {"median", "low", "high"}, "methods": [{"method", "key",
/// "volume", "shadow_map", "bytes", "frame_ms", "holds", "chosen": {"error", "ratio"}, "judged": the
/// same}]}]}]}.
std::string front_json(std::span<const Front> fronts);

/// As tables for a terminal, one a front.
std::string front_tables(std::span<const Front> fronts);

}  // namespace airlight::quality
