#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "epipolar/grid.h"
#include "epipolar/space_math.h"
#include "scene/scene.h"

namespace airlight::epipolar {

/// The frame of epipolar space: unit, mutually perpendicular, world axes.
struct Axes {
  glm::dvec3 axis;  ///< from the eye to the light
  glm::dvec3 u;     ///< where θ = 0
  glm::dvec3 f;     ///< where θ = π/2
};

/// The axes for a unit direction to the light. They depend on that direction and the world axes alone, so the
/// grid does not spin with the camera. No choice is continuous everywhere (the hairy ball theorem); this one
/// jumps where the light is exactly below the eye, which is seen least. Based on: Frisvad, "Building an
/// Orthonormal Basis from a 3D Unit Vector Without Normalization", JGT 2012, with +Y as pole.
Axes make_axes(glm::dvec3 towards_light);

/// An interval of angles [rad].
struct Range {
  double lower, upper;
};

/// The smallest and largest angle between `axis` (unit) and the rays of an image, its borders included
/// (Wyman 2011, section 4.3). The extremes lie at the corners, at stationary points of the edges, or at ±axis
/// itself.
Range alpha_range(const scene::CameraFrame& camera, glm::dvec3 axis);

/// The smallest interval of θ that holds the rays of an image, its borders included: a full turn around 0
/// where the image holds axes.axis or −axes.axis. Its bounds may lie beyond ±π.
Range theta_range(const scene::CameraFrame& camera, const Axes& axes);

/// Which angles the grid covers.
enum class Ranges {
  frame,      ///< what the frame can see, in α, θ and φ
  alpha_phi,  ///< the same, and all θ: the paper's (Wyman 2011, section 4.3)
  full,       ///< all angles there are
};

/// Of EpipolarBlock::theta_growth: where planes are sparsest they are 1 / (1 − it) times as far apart as
/// equal ones.
inline constexpr double k_most_theta_growth = 0.8;

/// How the range of θ is cut into planes.
enum class ThetaCells {
  fitted,  ///< denser where their rays reach farther across the image, if the light is in view
  equal,   ///< the paper's
};

/// The uniform block of a view and one of its lights.
shaders::EpipolarBlock epipolar_block(const scene::View& view, const scene::Light& light,
                                      const Resolution& resolution, Ranges ranges, ThetaCells theta_cells);

/// The range of φ, for each half-plane's cell, in which the scene's box lies: nothing casts a shadow
/// elsewhere. Never too small; empty, (0, 0), where the box is not met.
std::vector<glm::vec2> box_ranges(const scene::Box& box, glm::dvec3 eye, const shaders::EpipolarBlock& block,
                                  int theta_count);

/// The counts of a grid for a view and one of its lights whose rows are nowhere more than a pixel apart in α
/// and θ; φ is left at its default.
Resolution pixel_exact(const scene::View& view, const scene::Light& light, Ranges ranges,
                       ThetaCells theta_cells);

}  // namespace airlight::epipolar
