#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "quality/image_io.h"
#include "quality/methods.h"
#include "quality/metrics.h"
#include "scene/scene.h"

namespace airlight::quality {

/// The names of the lights that a frame left out; empty for none.
std::string skipped_lights(const frame::FrameImages& images);

/// How the image of a view was made.
struct Making {
  std::string scene;                                 ///< as the user named it
  std::map<std::string, std::string> model_options;  ///< that were given: albedo, looks, triangles
  const VolumeChoice& volume;                        ///< fitted to the view
  const SurfaceChoice& surface;                      ///< the same
  int shadow_map;                                    ///< side of a face [texels]
  float exposure;
  scene::ToneMap tone_map;
  std::string renderer;
  std::string command;  ///< repeats it
};

/// What the metadata of an image say of it: all choices of its view, methods and options, and what it was
/// made by, each under "airlight." and the name of its option.
std::map<std::string, std::string> metadata_of(const Making& making, const scene::View& view);

/// The layers of a frame's image: R,G,B; airlight.R,G,B; surface.Y, the mean over lights; distance.Y; of a
/// method that shows what light passes also surface.R,G,B. Where there are several lights, each has its
/// airlight.NAME.R,G,B and surface.NAME.Y, or surface.NAME.R,G,B, too.
class FrameLayers {
 public:
  /// @param images has to stay
  explicit FrameLayers(const frame::FrameImages& images);
  const std::map<std::string, ImageView::Channel>& channels() const { return channels_; }

 private:
  std::map<std::string, ImageView::Channel> channels_;
  std::vector<float> mean_visibility_;  ///< of several lights
};

/// Writes a frame's layers as an EXR image; lights that were skipped are named in the metadata.
/// @throws as write_exr
void write_frame(const std::filesystem::path& file, const frame::FrameImages& images,
                 std::map<std::string, std::string> metadata);

/// The exposure that maps the 95th percentile of the pixels' largest channel to 0.8; where that is black, the
/// largest value; 1 for a black image.
float automatic_exposure(const std::vector<glm::vec3>& radiance);

/// The size, relative to the reference's mean airlight, of an error below which a heat map is white, and of
/// the one from which on its colour is full.
constexpr double k_error_white = 1e-3, k_error_full = 1.0;

/// A signed heat map of x − r, averaged over RGB, relative to mean(r): white below `k_error_white`, then
/// logarithmic up to `k_error_full`; red where x is too bright, blue where it is too dark. Linear colours.
std::vector<glm::vec3> error_colours(const std::vector<glm::vec3>& x, const std::vector<glm::vec3>& r);

/// ꟻLIP from 0 to 1 in colours that grow brighter: black, violet, red, yellow, white. Linear colours.
std::vector<glm::vec3> flip_colours(const std::vector<float>& map);

/// The part of the lights that each surface sees, in grey: black where no surface is seen. Over it red where
/// that is wrong for a light, else yellow where it is undecided for one; a light that was skipped counts in
/// nothing. Linear colours.
/// @param verdicts for each light
std::vector<glm::vec3> surface_colours(const frame::FrameImages& images,
                                       const std::vector<SurfaceVerdicts>& verdicts);

}  // namespace airlight::quality
