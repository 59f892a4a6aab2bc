#pragma once

#include <glm/glm.hpp>

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

/// The uniform block of a view for a grid of `alpha_count` cells in α.
shaders::EpipolarBlock epipolar_block(const scene::View& view, int alpha_count);

}  // namespace airlight::epipolar
