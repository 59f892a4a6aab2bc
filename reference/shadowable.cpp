#include "reference/shadowable.h"

namespace airlight::reference {

Shadowable::Shadowable(const scene::Box& box, const glm::dvec3& eye, const std::optional<glm::dvec3>& sun)
    : box_(sun) {
  if (!sun || box.empty()) return;
  // Wider than what single precision may widen a triangle by.
  const glm::dvec3 lower(box.lower), upper(box.upper), margin(1e-6 * glm::length(upper - lower));
  const glm::dvec3 ends[2] = {lower - margin - eye, upper + margin - eye};
  for (int axis = 0; axis < 3; ++axis) {
    for (const glm::dvec3& end : ends) {
      // A face, in the order of its corners around it.
      const auto corner = [&](int u, int v) {
        glm::dvec3 at;
        at[axis] = end[axis];
        at[(axis + 1) % 3] = ends[u][(axis + 1) % 3];
        at[(axis + 2) % 3] = ends[v][(axis + 2) % 3];
        return at;
      };
      box_.add({corner(0, 0), corner(1, 0), corner(1, 1)});
      box_.add({corner(0, 0), corner(1, 1), corner(0, 1)});
    }
  }
}

SunRay Shadowable::part_of(const SunRay& ray) {
  shadow_.trace(ray, box_);
  SunRay part = ray;
  if (!shadow_.lit_runs().empty() && shadow_.lit_runs().back().to == ray.to)
    part.to = shadow_.lit_runs().back().from;
  return part;
}

}  // namespace airlight::reference
