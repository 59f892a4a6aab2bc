#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "quality/judge.h"
#include "quality/measure.h"
#include "scene/path.h"
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
  /// A frame of the path.
  struct Frame {
    FrameCost cost;
    Errors errors;
    double flicker = std::numeric_limits<double>::quiet_NaN();  ///< since the frame before, if there is one
  };
  std::string key;                ///< see key_of
  std::optional<int> shadow_map;  ///< side of a cube face [texels], where a method reads it
  std::string volume, surface;    ///< specs, as the user wrote them
  std::string name;               ///< stem of its images' file names
  std::map<std::string, frame::OptionValue> settings;          ///< what the volume method was told
  std::map<std::string, frame::OptionValue> surface_settings;  ///< what the surface method was told
  std::string command;                                         ///< repeats this run
  bool is_judged = false;     ///< whether --max-error applies to its airlight
  bool is_yardstick = false;  ///< whether its frame time is what march_ratio divides
  Cost cost;
  double march_ratio = 0.0;  ///< frame time of the fastest reference-march / frame_ms; 0 when none was run
  Errors errors;             ///< of a path's frames those of the worst
  std::vector<DebugImage> debug_images;
  std::vector<Frame> path;      ///< its frames; empty without one
  std::size_t worst_frame = 0;  ///< of a path: the one with the largest error of airlight
};

/// What the worst of errors is told by: rrmse, unless the truth is dark; rmse decides among dark ones.
bool is_worse(const AirlightError& a, const AirlightError& b);

/// Over a path's frames; NaN, of a dark one, and of the first one's flicker, does not count, and is what is
/// left where there is nothing else.
struct Spread {
  double mean, worst;
};
struct PathSpreads {
  Spread ms, rrmse, same_surface_rrmse, flicker;
};
PathSpreads path_spreads(const Run& run);

/// A path that views were compared along.
struct ComparedPath {
  struct Frame {
    double time;           ///< [s]
    scene::Motion motion;  ///< since the frame before; of the first one all is new
    TruthFigures truth;
  };
  double seconds = 0.0;
  std::vector<Frame> frames;
};

struct Exposure {
  float value = 1.0f;
  bool is_automatic = false;  ///< chosen by `automatic_exposure`
  bool is_of_black = false;   ///< whether the reference is black, so that any will do
};

/// The frames of a path that one motion leads to.
struct MotionShare {
  scene::Motion motion;
  int frames = 0;
  int shadow_maps = 0, volumes = 0;  ///< in how many of them they were redrawn
  double ms = 0.0;                   ///< mean time of a frame
};

/// Those of the motions that there are, the most restless first.
std::vector<MotionShare> shares_of_motion(const ComparedPath& path, const Run& run);

/// What `airlight compare` found.
struct Comparison {
  std::string scene;    ///< as the user named it
  std::string subject;  ///< see hash_of_subject
  std::size_t triangles = 0;
  scene::ImportReport report;
  scene::View view;
  int shadow_map_size = 0;
  Exposure exposure;
  gpu::Device device;
  unsigned cores = 0;
  TruthFigures truth;  ///< over all of a path: the largest bound, all of the time, means of what else
  std::vector<Run> runs;
  std::optional<ComparedPath> path;  ///< whose first frame is `view`
};

/// The program's version.
std::string version();

/// The comparison as results.json.
std::string results_json(const Comparison& comparison);

/// The comparison as a table for a terminal, each figure with its unit and what it was compared with.
std::string results_table(const Comparison& comparison);

/// Lays out rows of cells: the first `left` columns to the left, the others to the right.
std::string layout(const std::vector<std::vector<std::string>>& rows, std::size_t left);

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
