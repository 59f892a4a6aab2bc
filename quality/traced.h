#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frame/method.h"
#include "frame/surface_points.h"
#include "quality/metrics.h"
#include "quality/truth_cache.h"
#include "reference/reference.h"

namespace airlight::quality {

/// Tells how far long work is: what is being done, and the fraction done of it.
using Progress = std::function<void(const std::string& what, double fraction)>;

/// What the methods of the CPU share over one view: the acceleration structures, and each image that is asked
/// for twice.
class SharedReference {
 public:
  /// @param geometry at rest; @param view both kept by reference
  /// @param cache folder where the truth is kept between runs of the program (TruthCache); empty for none
  SharedReference(const scene::Geometry& geometry, const scene::View& view, Progress progress,
                  const std::filesystem::path& cache = {});
  ~SharedReference();
  SharedReference(const SharedReference&) = delete;
  SharedReference& operator=(const SharedReference&) = delete;

  /// Does what goes before the first ray, unless it is done, so that no frame is charged for it.
  void prepare();

  /// As `prepare`, where the images of `exact` and `distance` are not kept from an earlier run.
  void prepare_truth(int refinement);

  /// Along the view ray of each pixel to what it hits first [m]; 0 where it hits nothing.
  const std::vector<float>& distance();

  // Of one of the view's lights:
  /// Judged anew where the points are not those of the last call.
  /// @param points of a frame of the view
  const SurfaceVerdicts& verdicts(std::size_t light, const frame::SurfacePoints& points);
  const reference::AirlightImage& exact(std::size_t light, int refinement);
  // Traced anew:
  reference::AirlightImage sampled(std::size_t light, int samples);
  reference::AirlightImage march(std::size_t light, int steps, reference::RayMode rays);

  /// The same of the scene with opaque triangles alone, where light passes any; else nullptr. Its work is not
  /// counted here.
  SharedReference* taken_opaque();

  /// What was asked for since the last `take_work`.
  struct Work {
    std::uint64_t airlight_rays = 0;  ///< occlusion rays for airlight
    double airlight_ms = 0.0;         ///< time of tracing airlight
    double self_error = 0.0;          ///< the largest of reference::AirlightImage::self_error
    /// Time that was not spent now, because images had been kept: for each light by the stage that it would
    /// have been spent in, of airlight "integrate", of verdicts "surface_query".
    std::map<std::size_t, std::map<std::string, double>> kept_ms;
    double kept_ms_of(const std::string& stage) const;  ///< over all lights
  };
  Work take_work() { return std::exchange(work_, {}); }

 private:
  /// What is kept of one light.
  struct OfLight {
    std::optional<reference::Reference> rays;
    std::map<int, reference::AirlightImage> exact;  ///< by refinement
    // What was judged last:
    std::vector<std::uint32_t> triangles;  ///< as of frame::SurfacePoints
    std::vector<glm::vec4> points;         ///< as of frame::SurfacePoints
    SurfaceVerdicts verdicts;
    double verdicts_ms = 0.0;
  };

  const reference::Reference& rays(std::size_t light);
  bool load_distance();
  bool load_exact(std::size_t light, int refinement);
  void count(const reference::AirlightImage& image);
  reference::Progress report(const std::string& what) const;

  /// A copy of the geometry, and its reference.
  struct Opaque;

  /// Where the view has it.
  const scene::Geometry& geometry();

  const scene::Geometry& at_rest_;
  std::optional<scene::Geometry> posed_;  ///< made when it is first asked for
  const scene::View& view_;
  Progress progress_;
  std::filesystem::path cache_folder_;
  std::unique_ptr<Opaque> opaque_;
  std::optional<TruthCache> cache_;
  std::vector<OfLight> lights_;
  std::optional<std::vector<float>> distance_;
  Work work_;
};

/// A method of the CPU, which borrows what such methods share before its first frame.
class Traced {
 public:
  virtual ~Traced() = default;
  virtual void borrow(SharedReference& shared) = 0;
};

/// Lends to the method, where it is one of the CPU.
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

/// `reference` for surfaces: the verdicts of reference::SurfaceJudge on the frame's own points.
frame::SurfaceMethod reference_surface_method();

}  // namespace airlight::quality
