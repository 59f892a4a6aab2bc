#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "quality/methods.h"

namespace airlight::quality {

/// What a frame by a pair of methods costs. See docs/results.schema.json for the unit of each.
struct Cost {
  /// Of one light.
  struct OfLight {
    bool is_skipped = false;  ///< it cannot reach the view
    std::map<std::string, double> stages_ms;
  };
  std::map<std::string, double> stages_ms;  ///< of all lights, and what is no light's
  std::vector<OfLight> lights;

  std::ptrdiff_t skipped_lights() const {
    return std::count_if(lights.begin(), lights.end(), [](const OfLight& light) { return light.is_skipped; });
  }
  double frame_ms = 0.0;
  int frames = 0;
  std::map<std::string, std::int64_t> bytes;
  std::uint64_t rays = 0;    ///< 0 for a method that traces none
  double mrays_per_s = 0.0;  ///< 0 for a method that traces none
  double self_error = 0.0;   ///< reference::AirlightImage::self_error, of several lights the largest
};

/// Renders frames of one view by pairs of methods in turn, over one copy of the scene on the GPU, and times
/// them.
class Measurer {
 public:
  /// @param geometry, view kept by reference
  /// @param cache see SharedReference
  Measurer(gpu::Context& context, const scene::Geometry& geometry, const scene::View& view,
           int shadow_map_size, Progress progress, const std::filesystem::path& cache);

  /// Draws one frame with each method of the GPU, so that what the driver cannot do is known before long
  /// work.
  /// @throws scene::Error (driver)
  void try_out(std::span<const VolumeChoice> volumes, std::span<const SurfaceChoice> surfaces);

  frame::FrameImages render(const VolumeChoice& volume, const SurfaceChoice& surface);

  struct Measurement {
    Cost cost;
    frame::FrameImages images;
  };

  /// A frame's time is the median over whole frames, after one frame of warm-up and a few with timed stages.
  /// Where the first frame takes more than 2 s it is the only one.
  /// @param frames timed, after warm-up
  Measurement measure(const VolumeChoice& volume, const SurfaceChoice& surface, int frames);

  /// Pictures of what a volume method holds: see frame::Airlight::debug_images. Draws one more frame.
  std::vector<frame::DebugImage> debug_images(const VolumeChoice& volume);

  SharedReference& reference() { return reference_; }

 private:
  struct TimedFrame;
  TimedFrame render_timed(frame::SurfaceShadow& shadow, frame::Airlight& airlight, bool with_stages);
  void draw(frame::SurfaceShadow& shadow, frame::Airlight& airlight);

  gpu::Context& context_;
  const scene::View& view_;
  Progress progress_;
  frame::Frame frame_;
  SharedReference reference_;
};

}  // namespace airlight::quality
