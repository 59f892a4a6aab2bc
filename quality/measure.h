#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "frame/surface_points.h"
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
  double cpu_ms = 0.0;  ///< of the process; NaN where an image was kept from before
  int frames = 0;
  std::map<std::string, std::int64_t> bytes;
  /// What no machine bends, a pixel: see frame::Airlight::counters. None along a path.
  std::map<std::string, double> counters;
  std::uint64_t rays = 0;    ///< 0 for a method that traces none
  double mrays_per_s = 0.0;  ///< 0 for a method that traces none
  double self_error = 0.0;   ///< reference::AirlightImage::self_error, of several lights the largest
};

/// What one frame of a path costs.
struct FrameCost {
  double ms = 0.0;
  std::map<std::string, double> stages_ms;
  std::set<std::string> redrawn;  ///< see frame::Frame::redrawn
};

/// Renders frames of one view at a time by pairs of methods in turn, over one copy of the scene on the GPU,
/// and times them.
class Measurer {
 public:
  static constexpr double k_slow_frame_ms = 2000;  ///< a frame slower than this is timed once

  /// @param geometry, view kept by reference
  /// @param cache see SharedReference
  Measurer(gpu::Context& context, const scene::Geometry& geometry, const scene::View& view,
           int shadow_map_size, Progress progress, const std::filesystem::path& cache);

  /// Another view, kept by reference; nothing is kept of the last one's reference.
  void look_at(const scene::View& view);

  /// Draws one frame with each method of the GPU, so that what the driver cannot do is known before long
  /// work.
  /// @throws scene::Error (driver)
  void try_out(std::span<const VolumeChoice> volumes, std::span<const SurfaceChoice> surfaces);

  frame::FrameImages render(const VolumeChoice& volume, const SurfaceChoice& surface);

  /// What frames of the view shade, whatever their methods. Draws one more frame.
  frame::SurfacePoints surface_points();

  struct Measurement {
    Cost cost;
    frame::FrameImages images;
  };

  /// A frame's time is the median over whole frames, after a warm-up and a few with timed stages. The warm-up
  /// is one frame, on a GPU as many as take 0.3 s: one that has rested runs its first frames several times
  /// slower. Where the first frame takes more than 2 s it is the only one. Each frame draws all of its own.
  /// One more frame of methods of the GPU is drawn for counters.
  /// @param frames timed, after warm-up
  Measurement measure(const VolumeChoice& volume, const SurfaceChoice& surface, int frames);

  struct PathMeasurement {
    Cost cost;                      ///< means over the path's frames; of `bytes` the most
    std::vector<FrameCost> frames;  ///< one a view
  };

  /// Plays a path: once for warm-up and images, once with timed stages, then `plays` times; a frame's time is
  /// the median over those. Where half of the frames take more than 2 s the first play is the only one. What
  /// rests from a frame to the next is not drawn anew; the first frame of a play draws all of its own.
  /// @param views kept by reference; the last one is looked at afterwards
  /// @param look called with each view's number and image
  PathMeasurement measure_path(const VolumeChoice& volume, const SurfaceChoice& surface,
                               std::span<const scene::View> views, int plays,
                               const std::function<void(std::size_t, const frame::FrameImages&)>& look);

  /// A pair of methods, made.
  struct Pair {
    std::unique_ptr<frame::Airlight> airlight;
    std::unique_ptr<frame::SurfaceShadow> shadow;

    std::int64_t bytes() const;  ///< of the methods alone
  };
  Pair make(const VolumeChoice& volume, const SurfaceChoice& surface) const;

  /// The time of a whole frame.
  struct FrameTime {
    double ms, cpu_ms;  ///< as in Cost
  };

  /// Draws each of the views once, for those who order frames themselves. As along a path what rests from one
  /// to the next is not drawn anew.
  /// @param views kept by reference; the last one is looked at afterwards
  std::vector<FrameTime> play(const Pair& pair, std::span<const scene::View> views);

  /// Of the last frame.
  frame::FrameImages images() const { return frame_.read(); }
  /// GPU memory of the last frame, without its methods' own.
  std::int64_t shared_bytes() const;

  /// Pictures of what a volume method holds: see frame::Airlight::debug_images. Draws one more frame.
  std::vector<frame::DebugImage> debug_images(const VolumeChoice& volume);

  SharedReference& reference() { return *reference_; }

 private:
  struct TimedFrame;
  TimedFrame render_timed(std::span<const scene::View> views, std::size_t index, frame::SurfaceShadow& shadow,
                          frame::Airlight& airlight, bool with_stages);
  void warm_up(frame::SurfaceShadow& shadow, frame::Airlight& airlight);
  TimedFrame render_timed(frame::SurfaceShadow& shadow, frame::Airlight& airlight, bool with_stages,
                          frame::Resting resting = frame::Resting::redrawn);
  std::map<std::string, std::int64_t> bytes_of(const frame::SurfaceShadow& shadow,
                                               const frame::Airlight& airlight) const;
  void draw(frame::SurfaceShadow& shadow, frame::Airlight& airlight);
  std::map<std::string, double> count(frame::SurfaceShadow& shadow, frame::Airlight& airlight);

  gpu::Context& context_;
  const scene::Geometry& geometry_;
  const scene::View* view_;
  Progress progress_;
  std::filesystem::path cache_;
  frame::Frame frame_;
  std::optional<SharedReference> reference_;
};

}  // namespace airlight::quality
