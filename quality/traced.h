#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frame/method.h"
#include "quality/truth_cache.h"
#include "reference/reference.h"

namespace airlight::quality {

/// Tells how far long work is: what is being done, and the fraction done of it.
using Progress = std::function<void(const std::string& what, double fraction)>;

/// What the methods that trace rays share over one view: the acceleration structures, and each image that is
/// asked for twice.
class SharedReference {
 public:
  /// @param geometry, view kept by reference
  /// @param cache folder where the truth is kept between runs of the program (TruthCache); empty for none
  SharedReference(const scene::Geometry& geometry, const scene::View& view, Progress progress,
                  const std::filesystem::path& cache = {});

  /// Does what goes before the first ray, unless it is done, so that no frame is charged for it.
  void prepare();

  /// As `prepare`, where the images of `exact` and `surfaces` are not kept from an earlier run.
  void prepare_truth(int refinement);

  // Of one of the view's lights:
  const reference::SurfaceImage& surfaces(std::size_t light);
  const reference::AirlightImage& exact(std::size_t light, int refinement);
  // Traced anew:
  reference::AirlightImage sampled(std::size_t light, int samples);
  reference::AirlightImage march(std::size_t light, int steps, reference::RayMode rays);

  /// What was asked for since the last `take_work`.
  struct Work {
    std::uint64_t airlight_rays = 0;  ///< occlusion rays for airlight
    double airlight_ms = 0.0;         ///< time of tracing airlight
    double self_error = 0.0;          ///< the largest of reference::AirlightImage::self_error
    /// Time that was not spent now, because images had been kept: for each light by the stage that it would
    /// have been spent in, of airlight "integrate", of surfaces "surface_query".
    std::map<std::size_t, std::map<std::string, double>> kept_ms;
    double kept_ms_of(const std::string& stage) const;  ///< over all lights
  };
  Work take_work() { return std::exchange(work_, {}); }

 private:
  /// What is kept of one light.
  struct OfLight {
    std::optional<reference::Reference> rays;
    std::optional<reference::SurfaceImage> surfaces;
    double surfaces_ms = 0.0;
    std::map<int, reference::AirlightImage> exact;  ///< by refinement
  };

  const reference::Reference& rays(std::size_t light);
  bool load_surfaces(std::size_t light);
  bool load_exact(std::size_t light, int refinement);
  void count(const reference::AirlightImage& image);
  reference::Progress report(const std::string& what) const;

  const scene::Geometry& geometry_;
  const scene::View& view_;
  Progress progress_;
  std::optional<TruthCache> cache_;
  std::vector<OfLight> lights_;
  Work work_;
};

/// A method that traces rays on the CPU, and borrows what such methods share before its first frame.
class Traced {
 public:
  virtual ~Traced() = default;
  virtual void borrow(SharedReference& shared) = 0;
};

/// Lends to the method, where it is one that traces rays.
template <typename MadeMethod>
void lend(SharedReference& shared, MadeMethod& method) {
  if (auto* traced = dynamic_cast<Traced*>(&method)) traced->borrow(shared);
}

/// `reference`: the truth, without sampling.
frame::AirlightMethod reference_method();

/// `reference-sampled`: converged ray tracing.
frame::AirlightMethod reference_sampled_method();

/// `reference-march`: a shadow ray at every step.
frame::AirlightMethod reference_march_method();

/// `reference` for surfaces: a shadow ray a pixel. A pixel whose surface the G-buffer sees and the rays miss,
/// at an edge, is dark.
frame::SurfaceMethod reference_surface_method();

}  // namespace airlight::quality
