#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace airlight::scene {

struct Geometry;

/// A rotation and a shift of world space.
struct Rigid {
  glm::dmat4 matrix{1.0};  ///< its upper left 3×3 a rotation to 1e-12, its last row 0, 0, 0, 1

  glm::dvec3 operator()(glm::dvec3 point) const { return glm::dvec3(matrix * glm::dvec4(point, 1.0)); }
  glm::dvec3 turned(glm::dvec3 direction) const { return glm::dmat3(matrix) * direction; }
  bool is_identity() const { return matrix == glm::dmat4(1.0); }
  bool operator==(const Rigid&) const = default;
};

/// What moves in a scene, each part of it as one. Made once for all views of a path.
struct Objects {
  std::vector<std::string> names;          ///< of each, for messages
  std::vector<std::uint32_t> of_triangle;  ///< of the geometry: 1 + which object it is of, 0 of what rests
};

/// Where a view has a scene's objects.
struct Pose {
  std::shared_ptr<const Objects> objects = nullptr;  ///< nullptr where nothing moves
  std::vector<Rigid> motions = {};                   ///< of each object, from where the scene has it
  bool operator==(const Pose&) const = default;

  /// Whether all is where the scene has it.
  bool is_at_rest() const;
};

/// Moves positions and normals of the pose's objects.
/// @param posed a copy of `at_rest`, in any pose of the same objects, no two of which share a position
/// @throws Error (bad_file) naming the object where a position overflows single precision, or a triangle has
/// no area left there, when its corners are rounded
void set_pose(Geometry& posed, const Geometry& at_rest, const Pose& pose);

/// The same of a copy made here. What is left as it was: the order of all positions and triangles, and what
/// rests, bit for bit.
Geometry posed(const Geometry& at_rest, const Pose& pose);

}  // namespace airlight::scene
