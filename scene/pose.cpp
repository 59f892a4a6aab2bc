#include "scene/pose.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include "scene/error.h"
#include "scene/scene.h"

namespace airlight::scene {

bool Pose::is_at_rest() const {
  return std::all_of(motions.begin(), motions.end(),
                     [](const Rigid& motion) { return motion.is_identity(); });
}

void set_pose(Geometry& posed, const Geometry& at_rest, const Pose& pose) {
  if (!pose.objects) return;
  const Objects& objects = *pose.objects;
  assert(objects.of_triangle.size() == at_rest.triangles.size());
  assert(pose.motions.size() == objects.names.size());
  const auto error = [&](std::uint32_t object, const std::string& problem) {
    return Error(ExitCode::bad_file, fmt::format("'{}', moved", objects.names[object - 1]), problem,
                 "move it less far from the origin");
  };
  for (std::size_t i = 0; i < at_rest.triangles.size(); ++i) {
    const std::uint32_t object = objects.of_triangle[i];
    if (object == 0) continue;
    const Rigid& motion = pose.motions[object - 1];
    const glm::uvec3 t = at_rest.triangles[i];
    for (const glm::uint corner : {t.x, t.y, t.z}) {
      const glm::dvec3 moved = motion(glm::dvec3(at_rest.positions[corner]));
      const glm::dvec3 size = glm::abs(moved);
      if (!(std::max({size.x, size.y, size.z}) <= k_largest_coordinate))
        throw error(object, fmt::format("its coordinates overflow single precision: they reach {:g} m",
                                        std::max({size.x, size.y, size.z})));
      posed.positions[corner] = glm::vec3(moved);
    }
    if (!has_area(posed.positions[t.x], posed.positions[t.y], posed.positions[t.z]))
      throw error(object, "one of its triangles has no area there, when its corners are rounded");
    if (at_rest.normals.empty()) continue;
    for (std::size_t corner = 0; corner < 3; ++corner)
      posed.normals[i][corner] = glm::vec3(unit(motion.turned(glm::dvec3(at_rest.normals[i][corner]))));
  }
}

Geometry posed(const Geometry& at_rest, const Pose& pose) {
  Geometry result = at_rest;
  set_pose(result, at_rest, pose);
  return result;
}

}  // namespace airlight::scene
