#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace airlight::frame {

/// A run of neighbouring triangles.
struct Cluster {
  std::uint32_t first_triangle;
  std::uint32_t triangle_count;
  scene::Box box;  ///< world space
};

/// The triangles of a scene in an order where neighbours in the list are neighbours in space, cut into
/// clusters, so that a pass can leave out what it cannot see.
struct Clusters {
  std::vector<std::uint32_t> order;  ///< order[i]: which triangle of the geometry comes i-th
  std::vector<Cluster> clusters;
  /// The place in `order` of the first triangle of which parts are cut out (scene::CutOut): these are the
  /// last ones, and no cluster is of both kinds.
  std::uint32_t first_cut_out = 0;
};

inline constexpr std::uint32_t k_cluster_triangles = 128;

/// Sorts triangles by the Morton code of their centroids, whole ones first.
Clusters make_clusters(const scene::Geometry& geometry);

/// Fits the clusters' boxes to where the geometry's positions are now.
void fit_boxes(Clusters& clusters, const scene::Geometry& geometry);

/// A pyramid without a base, open at infinity.
struct Pyramid {
  glm::dvec3 apex;                 ///< world space
  glm::dvec3 right, up, forward;   ///< orthonormal
  double half_width, half_height;  ///< slopes of its sides
};

/// The half-spaces through the origin, by their inward unit normals, that bound the cone of the sums of
/// multiples ≥ 0 of some unit directions: the planes through two of them that leave all others on one side.
/// None for a cone that is all of space.
/// @param rounding how far a direction may lie beyond such a plane
std::vector<glm::dvec3> sides_of_cone(std::span<const glm::dvec3> directions, double rounding);

/// Whether a box may touch the region that half-spaces bound whose planes meet in a point: never wrongly
/// "no".
/// @param apex   that point, world space
/// @param inward normals of the planes
bool may_touch(glm::dvec3 apex, std::span<const glm::dvec3> inward, const scene::Box& box);

/// The same for the pyramid.
bool may_touch(const Pyramid& pyramid, const scene::Box& box);

/// A lower bound of the distance from a point to the geometry [m], exact where the geometry's nearest
/// triangle decides; +Inf without triangles.
double distance_to_geometry(const scene::Geometry& geometry, const Clusters& clusters, glm::dvec3 point);

/// The triangles no farther than `reach` [m] from a point, by their places in the order of the clusters,
/// sorted.
std::vector<std::uint32_t> triangles_within(const scene::Geometry& geometry, const Clusters& clusters,
                                            glm::dvec3 point, double reach);

}  // namespace airlight::frame
