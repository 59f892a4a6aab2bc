#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quality/methods.h"
#include "quality/results.h"

namespace airlight::quality {

struct CompareRequest {
  std::string scene_name;  ///< as the user named it
  const scene::Scene& scene;
  const scene::View& view;
  const scene::Path* path;  ///< which begins with `view`; nullptr for none
  std::vector<VolumeChoice> volumes;
  std::vector<SurfaceChoice> surfaces;
  int shadow_map_size;              ///< side of a cube face [texels]
  int frames;                       ///< timed a run, after warm-up; along a path, of each of its frames
  std::optional<float> exposure;    ///< of the PNG previews; automatic without
  std::filesystem::path directory;  ///< exists; gets the images
  std::filesystem::path cache;      ///< where the truth is kept; empty for nowhere
  bool debug = false;               ///< write the volume methods' debug images too
  /// All of the command that repeats one pair of methods, but -o.
  std::function<std::string(const VolumeChoice&, const SurfaceChoice&)> command;
  Progress progress;  ///< may be empty
  /// Also shows each image, as soon as it is there, by the stem of its file's name; may be empty.
  std::function<void(const std::string&, const frame::FrameImages&)> show = {};
};

/// Called with a run as far as it is known, a view's number and the run's image of it.
using Look = std::function<void(const Run&, std::size_t, const frame::FrameImages&)>;

/// Measures and judges one pair of methods; the run's command is left empty.
/// @param views the one that is looked at, or where `is_path` says so those of a path, one truth each
/// @param frames as in CompareRequest; @param look may be empty
Run judged_run(Measurer& measurer, std::span<const scene::View> views, bool is_path,
               std::span<const Truth> truths, const VolumeChoice& volume, const SurfaceChoice& surface,
               int frames, const Look& look);

/// Measures every volume method with every surface method, judges them by the reference, and writes
/// the images: reference.exr and .png, and for each run NAME.exr, NAME.png, NAME_error.png (`error_colours`)
/// and NAME_surface.png (`surface_colours`); where asked for, the debug images of each volume method, as
/// NAME_IMAGE.exr, channel Y, and NAME_IMAGE.png, where the largest value is white.
///
/// Along a path: every frame of it is judged and timed, as Measurer::measure_path does. Of the images the PNG
/// ones alone are written, of each frame, whose number ends their names, as in NAME_0007.png, and no debug
/// images.
/// @throws scene::Error as the methods do; (driver) before the reference is traced, where the driver cannot
/// draw what is asked for
Comparison compare(gpu::Context& context, const CompareRequest& request);

}  // namespace airlight::quality
