#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

namespace airlight::quality {

/// What a run is told by, mean over its views; NaN where there is none.
struct Figures {
  static constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
  double ms = k_none;                              ///< frame time
  double ms_low = k_none, ms_high = k_none;        ///< its 95 % interval, of a sweep's runs
  double ratio = k_none;                           ///< time / baseline's, of a sweep's runs
  double ratio_low = k_none, ratio_high = k_none;  ///< its 95 % interval
  double rrmse = k_none;                           ///< of the airlight where both see the same surface
  double p99 = k_none, flip = k_none;              ///< of the airlight
  double flicker = k_none;                         ///< along a path
  double wrong = k_none, pixel = k_none;           ///< wrong surface pixels, and one pixel, of all
  double bytes = 0.0;                              ///< of GPU memory, scene and shadow map included
};

/// A run of `airlight compare` or `airlight sweep`.
struct JoinedRun {
  nlohmann::ordered_json json;  ///< as in results.json and runs.jsonl
  std::string key;
  std::string volume, surface;  ///< specs
  std::optional<int> shadow_map;
  std::size_t device = 0;  ///< of JoinedRuns::devices
  Figures figures;
  std::filesystem::path image;  ///< folder and stem of its images, of `compare`; empty of a sweep's
};

/// Runs of one scene, seen by the same views.
struct JoinedRuns {
  std::string scene;  ///< as the user named it
  glm::ivec2 size{0};
  std::size_t views = 1;             ///< more than one along a path
  std::vector<std::string> devices;  ///< that runs ran on
  std::vector<JoinedRun> runs;
  /// What the first results.json says of all of its runs, as the view and the truth; null where sweeps alone
  /// are joined.
  nlohmann::ordered_json comparison;
  std::filesystem::path truth;  ///< folder and stem of the truth's images; empty without results.json
};

/// Reads what `airlight compare` and `airlight sweep` have written: folders with results.json, runs.jsonl or
/// runs-K-of-N.jsonl, and such files themselves. Of a run that is there several times on one device, as its
/// key tells, the first one's figures count, and the images of the first that has some.
/// @throws scene::Error (bad_file) naming the place that is missing, holds no runs, or holds what is none,
/// and the place whose scene, views or truth are not those of the first
JoinedRuns join_runs(std::span<const std::filesystem::path> places);

/// The number there; NaN where there is none.
double number_at(const nlohmann::ordered_json& json, const std::string& pointer);

/// A column of a run's frames along a path, as "rrmse"; NaN where a frame has none. Of an image of a sweep it
/// has one value, of one of `compare` none.
std::vector<double> over_views(const nlohmann::ordered_json& run, const char* column);

/// Over those that are numbers; NaN where none is.
double mean_of(const std::vector<double>& values);

}  // namespace airlight::quality
