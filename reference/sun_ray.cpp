#include "reference/sun_ray.h"

#include <algorithm>
#include <cassert>
#include <cmath>

// A point at t lies (height of the top over it) / l_y from where the sun's light enters the layer. That
// height is max(−eye_y, 0) at `from` and falls by w_y a metre.

namespace airlight::reference {

glm::dvec3 SunRay::end() const {
  return std::isinf(to) ? far_end(glm::dvec3(0.0), w) : to * w;
}

SunRay make_sun_ray(const glm::dvec3& l, const glm::dvec3& direction, const glm::dvec3& right,
                    double distance, double smallest_alpha, std::optional<double> eye_y) {
  const LightPlane plane = make_light_plane(l, direction, right, smallest_alpha);
  const Stretch inside = in_medium(eye_y, plane.w.y, distance);
  if (!eye_y) return {plane, inside.from, inside.to, 0.0, 1.0};
  assert(l.y > 0.0);
  return {plane, inside.from, inside.to, std::max(-*eye_y, 0.0) / l.y, (l.y - plane.w.y) / l.y};
}

}  // namespace airlight::reference
