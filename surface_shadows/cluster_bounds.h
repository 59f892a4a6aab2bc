#pragma once

#include <span>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace airlight::surface_shadows {

/// What bounds a few triangles: a capsule, two slabs, and a cone of normals. All of it holds of the corners
/// as the floats that they are: rounded outward.
struct ClusterBounds {
  /// Corners lie within `radius` [m] of the segment from `from` to `to`, world space; of a sphere these are
  /// its centre.
  glm::vec3 from{0.0f};
  float radius = 0.0f;
  glm::vec3 to{0.0f};
  /// Normals (b − a) × (c − a) lie within this angle of `axis` [rad]; `k_any_direction` where they may have
  /// any direction.
  float opening = 0.0f;
  glm::vec3 axis{0.0f, 0.0f, 1.0f};  ///< of unit length
  float least_altitude = 0.0f;       ///< of the triangles [m]: 0 where one has its corners in line
  float lower = 0.0f, upper = 0.0f;  ///< corners are so high along `axis` over `from` [m]

  bool is_sphere() const { return from == to; }
};

inline constexpr float k_any_direction = 4.0f;

/// The bounds of some triangles of a scene, at least one: a capsule where their extent along one axis is at
/// least twice that along any other, else the smallest sphere.
/// Based on: Deves, Mora, Aveneau, Ghazanfarpour, "Scalable Real-Time Shadows using Clustering and Metric
/// Trees", EGSR 2018, section 4. The ends of a capsule are no farther apart than its corners need, where the
/// paper gives it the whole extent.
ClusterBounds bounds_of(const scene::Geometry& geometry, std::span<const glm::uvec3> triangles,
                        bool has_capsules = true);

/// The bounds of the same triangles after a motion, of their corners as they are rounded there.
/// @param bounds of them at rest
ClusterBounds moved(const ClusterBounds& bounds, const scene::Rigid& motion);

}  // namespace airlight::surface_shadows
