#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "scene/scene.h"

namespace airlight::reference {

/// Raised with every change of the code that changes an image of the truth: images kept on disk are told
/// apart by it.
inline constexpr int k_truth_version = 1;

/// The ground truth of a view, row 0 at the top. Radiances are RGB, unclamped [W/(m² sr)].
struct SurfaceImage {
  std::vector<float> distance;  ///< along the view ray from the eye [m]; 0 where nothing is hit
  /// 1 where nothing lies between the light and the surface, 0 in shadow and where nothing is hit. A surface
  /// does not shadow itself: where it turns its back to the light, it is up to the shading to be black.
  std::vector<float> visibility;
};

struct AirlightImage {
  std::vector<glm::vec3> radiance;
  std::uint64_t rays = 0;  ///< occlusion rays traced
  double ms = 0.0;  ///< wall-clock time of tracing and integrating, primary rays included, BVH build left out
  double self_error = 0.0;  ///< rrmse between this image and the one of half as many samples (converged only)
};

enum class RayMode { single, packet };

using Progress = std::function<void(double fraction)>;  ///< called from the calling thread only

/// Exact visibility by ray casting (Embree), on every core.
///
/// Shares no code with the methods that it judges. Geometry is held relative to the light, so that
/// coordinates far from the origin cost no precision.
class Reference {
 public:
  /// Builds the acceleration structure. The geometry is copied.
  /// @param light which of the view's lights: the others are out
  Reference(const scene::Geometry& geometry, const scene::View& view, std::size_t light = 0);
  ~Reference();
  Reference(Reference&&) noexcept;
  Reference& operator=(Reference&&) noexcept;

  /// First hits of the rays through pixel centres, and whether each is lit.
  SurfaceImage surfaces(const Progress& progress = {}) const;

  /// `reference-march`: the Riemann sum over `samples` shadow rays per view ray, at the centres of `samples`
  /// equal steps of φ ∈ [0, φ_d]: what Wyman (2011, Fig. 16) times voxelized shadow volumes against.
  AirlightImage march(int samples, RayMode mode, const Progress& progress = {}) const;

  /// `reference`: the converged airlight. `samples` uniform steps in φ find the visibility changes, each is
  /// bisected to 1e-6 of the range, and lit runs are integrated by Gauss–Legendre quadrature in double
  /// precision.
  AirlightImage converged(int samples, const Progress& progress = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace airlight::reference
