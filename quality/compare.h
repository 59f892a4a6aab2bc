#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "quality/image_io.h"
#include "quality/methods.h"
#include "quality/results.h"

namespace airlight::quality {

struct CompareRequest {
  std::string scene_name;  ///< as the user named it
  const scene::Scene& scene;
  const scene::View& view;
  std::vector<VolumeChoice> volumes;
  std::vector<SurfaceChoice> surfaces;
  int shadow_map_size;              ///< side of a cube face [texels]
  int reference_samples;            ///< of the truth
  int frames;                       ///< timed a run, after warm-up
  std::optional<float> exposure;    ///< of the PNG previews; automatic without
  std::filesystem::path directory;  ///< exists; gets the images
  bool debug = false;               ///< write the volume methods' debug images too
  std::string command;              ///< all of the command but --volume, --surface and -o
  Progress progress;                ///< may be empty
};

/// Runs every volume method with every surface method, times them, judges them by the converged reference,
/// and writes the images: reference.exr and .png, and for each run NAME.exr, NAME.png and NAME_error.png
/// (`error_colours`); where asked for, the debug images of each volume method, as NAME_IMAGE.exr, channel Y,
/// and NAME_IMAGE.png, where the largest value is white.
///
/// A run's time is the median over whole frames, after one frame of warm-up and a few with timed stages.
/// Where the first frame takes more than 2 s it is the only one.
/// @throws scene::Error as the methods do; (driver) before the reference is traced, where the driver cannot
/// draw what is asked for
Comparison compare(gpu::Context& context, const CompareRequest& request);

/// An image with the channels R,G,B; airlight.R,G,B; surface.Y; distance.Y.
Image exr_image(const frame::FrameImages& images, std::map<std::string, std::string> metadata);

/// The exposure that maps the 95th percentile of the pixels' largest channel to 0.8; where that is black, the
/// largest value; 1 for a black image.
float automatic_exposure(const std::vector<glm::vec3>& radiance);

/// The size, relative to the reference's mean airlight, of an error below which a heat map is white, and of
/// the one from which on its colour is full.
constexpr double k_error_white = 1e-3, k_error_full = 1.0;

/// A signed heat map of x − r, averaged over RGB, relative to mean(r): white below `k_error_white`, then
/// logarithmic up to `k_error_full`; red where x is too bright, blue where it is too dark. Linear colours.
std::vector<glm::vec3> error_colours(const std::vector<glm::vec3>& x, const std::vector<glm::vec3>& r);

/// Words fit for a shell, quoted where they need it.
std::string shell_quote(const std::string& word);

}  // namespace airlight::quality
