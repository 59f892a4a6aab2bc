#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "scene/parallel.h"
#include "scene/scene.h"

namespace airlight::reference {

/// Raised with every change of the code that changes an image of the truth: images kept on disk are told
/// apart by it.
inline constexpr int k_truth_version = 2;

/// The ground truth of a view, row 0 at the top. Radiances are RGB, unclamped [W/(m² sr)].
struct SurfaceImage {
  std::vector<float> distance;  ///< along the view ray from the eye [m]; 0 where nothing is hit
  /// 1 where the side that is seen is lit: it faces the light and nothing lies between; else 0, and where
  /// nothing is hit.
  std::vector<float> visibility;
};

struct AirlightImage {
  std::vector<glm::vec3> radiance;
  /// Wall-clock time of tracing and integrating, primary rays included; of `exact` with building its
  /// hierarchy, of the others without.
  double ms = 0.0;
  std::uint64_t rays = 0;   ///< occlusion rays traced, where there are any
  double self_error = 0.0;  ///< `sampled`: rrmse between this image and the one of half as many samples
  // `exact`:
  double bound = 0.0;              ///< of the rrmse between this image and the truth
  double shadows_per_pixel = 0.0;  ///< triangles that hide a part of a view ray
  double lit_runs_per_pixel = 0.0;
};

enum class RayMode { single, packet };

using Progress = scene::Progress;

/// Exact visibility by ray casting (Embree), on every core.
///
/// Shares no code with the methods that it judges. Geometry is held relative to the light, or to the eye
/// under a sun, so that coordinates far from the origin cost no precision.
class Reference {
 public:
  /// Builds the acceleration structure. The geometry is copied.
  /// @param light which of the view's lights: the others are out
  Reference(const scene::Geometry& geometry, const scene::View& view, std::size_t light = 0);
  ~Reference();
  Reference(Reference&&) noexcept;
  Reference& operator=(Reference&&) noexcept;

  /// From now on images are of this size [pixels]; nothing is built anew. @throws scene::Error as
  /// camera_frame
  void resize(glm::ivec2 image_size);

  /// First hits of the rays through pixel centres, and whether each is lit.
  SurfaceImage surfaces(const Progress& progress = {}) const;

  /// `reference-march`: the Riemann sum over `samples` shadow rays per view ray, at the centres of `samples`
  /// equal steps of φ ∈ [0, φ_d]: what Wyman (2011, Fig. 16) times voxelized shadow volumes against. Under a
  /// sun the steps are those of t, as far as the scene can cast shadows, and what they light is integrated in
  /// closed form.
  AirlightImage march(int samples, RayMode mode, const Progress& progress = {}) const;

  /// `reference-sampled`: `samples` uniform steps in φ (under a sun as `march`) find the visibility changes,
  /// each is bisected to 1e-6 of the range, and lit runs are integrated as by `exact`.
  AirlightImage sampled(int samples, const Progress& progress = {}) const;

  /// `reference`: the truth. The union of the intervals that the scene's triangles hide, in double precision,
  /// integrated by Gauss–Legendre quadrature, or under a sun in closed form: nothing is sampled.
  /// @param refinement parts that each panel of the quadrature is cut into: tests its bound
  AirlightImage exact(int refinement = 1, const Progress& progress = {}) const;

  /// The same of some tiles of k_tile² pixels, those at the image's right and lower sides cut, by their
  /// columns and rows, each once: figures are of their pixels, radiance elsewhere 0.
  AirlightImage exact_in(std::span<const glm::ivec2> tiles, int refinement = 1,
                         const Progress& progress = {}) const;
  static constexpr int k_tile = 8;

 private:
  struct State;
  template <class Ray>
  class TileIntegrator;
  template <class Ray>
  AirlightImage exact_along(std::span<const glm::ivec2> tiles, int refinement,
                            const Progress& progress) const;
  template <class Ray>
  AirlightImage sampled_along(int samples, const Progress& progress) const;
  AirlightImage march_to_sun(int samples, RayMode mode, const Progress& progress) const;
  AirlightImage march_to_point(int samples, RayMode mode, const Progress& progress) const;
  std::unique_ptr<State> state_;
};

}  // namespace airlight::reference
