#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "quality/judge.h"
#include "quality/measure.h"
#include "scene/scene.h"

namespace airlight::quality {

/// One volume method with one surface method, timed and judged. See docs/results.schema.json for the unit of
/// each.
struct Run {
  /// A debug image of its volume method.
  struct DebugImage {
    std::string name;  ///< stem of its files' names
    std::string caption;
    float white;  ///< the value that is white in the PNG
  };
  std::string volume, surface;                                 ///< specs, as the user wrote them
  std::string name;                                            ///< stem of its images' file names
  std::map<std::string, frame::OptionValue> settings;          ///< what the volume method was told
  std::map<std::string, frame::OptionValue> surface_settings;  ///< what the surface method was told
  std::string command;                                         ///< repeats this run
  bool is_judged = false;     ///< whether --max-error applies to its airlight
  bool is_yardstick = false;  ///< whether its frame time is what march_ratio divides
  Cost cost;
  double march_ratio = 0.0;  ///< frame time of the fastest reference-march / frame_ms; 0 when none was run
  Errors errors;
  std::vector<DebugImage> debug_images;
};

struct Exposure {
  float value = 1.0f;
  bool is_automatic = false;  ///< chosen by `automatic_exposure`
  bool is_of_black = false;   ///< whether the reference is black, so that any will do
};

/// What `airlight compare` found.
struct Comparison {
  std::string scene;  ///< as the user named it
  std::size_t triangles = 0;
  scene::ImportReport report;
  scene::View view;
  int shadow_map_size = 0;
  Exposure exposure;
  gpu::Device device;
  unsigned cores = 0;
  TruthFigures truth;
  std::vector<Run> runs;
};

/// The program's version.
std::string version();

/// The comparison as results.json.
std::string results_json(const Comparison& comparison);

/// The comparison as a table for a terminal, each figure with its unit and what it was compared with.
std::string results_table(const Comparison& comparison);

/// The names of all stages of all runs.
std::set<std::string> stages_of(const Comparison& comparison);

/// A row of the table of stages.
struct StagesRow {
  const Run& run;
  std::string light;  ///< its name; "all" for all lights, and what is no light's
  const std::map<std::string, double>& stages_ms;
};

/// Each run's, followed, where there are several lights, by one for each.
std::vector<StagesRow> stages_rows(const Comparison& comparison);

/// Says that the truth is dark, and what that means.
std::string dark_text(const TruthFigures& truth);

/// A relative airlight error in percent; one that is not above the truth's own reads "< that", one against a
/// dark truth "dark".
std::string error_text(double rrmse, double bound);

/// Every choice of a view under the name of the option that makes it; of several lights, under
/// light.NAME.OPTION.
std::map<std::string, std::string> view_options(const scene::View& view);

/// Words fit for a shell, quoted where they need it.
std::string shell_quote(const std::string& word);

/// @throws scene::Error (bad_file) when the file cannot be written to the end
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace airlight::quality
