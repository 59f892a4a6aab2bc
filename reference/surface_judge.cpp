#include "reference/surface_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reference/exact_sum.h"
#include "scene/parallel.h"

namespace airlight::reference {

namespace {

using Face = std::array<glm::vec3, 3>;

/// Points that one part of the work takes.
constexpr std::size_t k_part = 1024;

double largest_of(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

int sign_of(double value) {
  return value > 0.0 ? 1 : value < 0.0 ? -1 : 0;
}

/// A plane in double precision.
class Plane {
 public:
  /// Through a point, spanned by two directions that are exact or rounded once.
  Plane(const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v)
      : origin_(origin),
        normal_(glm::cross(u, v)),
        magnitude_(std::abs(u.y * v.z) + std::abs(u.z * v.y), std::abs(u.z * v.x) + std::abs(u.x * v.z),
                   std::abs(u.x * v.y) + std::abs(u.y * v.x)) {}

  /// dot(u × v, point − origin), and how far it may be off.
  ///
  /// Rounded to 2⁻⁵³ each are u, v, their products, the difference of two, point − origin, its products, and
  /// the two sums: of all terms together, to 8 times that. Twice that leaves room for the bound's own
  /// rounding.
  struct Height {
    double value, error;
    int sign() const { return std::abs(value) > error ? sign_of(value) : 0; }  ///< 0 where that is unknown
  };
  Height height(const glm::dvec3& point) const {
    const glm::dvec3 from_origin = point - origin_;
    return {glm::dot(normal_, from_origin), 0x1p-49 * glm::dot(magnitude_, glm::abs(from_origin))};
  }

  /// The most that a height changes where no coordinate does by more than `step`.
  double change(double step) const {
    const glm::dvec3 slope = glm::abs(normal_) + 0x1p-50 * magnitude_;
    return (slope.x + slope.y + slope.z) * step;
  }

 private:
  glm::dvec3 origin_, normal_, magnitude_;
};

Plane plane_of(const Face& face) {
  const glm::dvec3 a(face[0]);
  return {a, glm::dvec3(face[1]) - a, glm::dvec3(face[2]) - a};
}

/// The sign of det(b − a, c − a, point − a): on which side of the face the point is.
int side_of(const Face& face, const Plane& plane, const glm::dvec3& point) {
  if (const int sign = plane.height(point).sign()) return sign;
  const auto& [a, b, c] = face;
  ExactSum volume;
  volume.add_volume(a, b, point);
  volume.add_volume(b, c, point);
  volume.add_volume(c, a, point);
  volume.add_volume(a, b, glm::dvec3(c), -1);
  return volume.sign();
}

int side_of(const Face& face, const glm::dvec3& point) {
  return side_of(face, plane_of(face), point);
}

/// The plane in which light meets an edge.
class EdgePlane {
 public:
  /// @param along where a sun's light goes; a lamp is at the origin
  EdgePlane(const glm::vec3& from, const glm::vec3& to, const std::optional<glm::vec3>& along)
      : from_(from), to_(to), along_(along), plane_(make_plane()) {}

  const Plane& plane() const { return plane_; }

  /// On which side a point of the plane comes to lie that is moved a little along x, less along y, least
  /// along z: the sign of the normal's first component that is not 0.
  int side_of_shift() const {
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 shift(0.0);
      shift[axis] = 1.0;
      ExactSum slope;
      if (along_) {
        slope.add_volume(*along_, to_, shift);
        slope.add_volume(*along_, from_, shift, -1);
      } else {
        slope.add_volume(from_, to_, shift);
      }
      if (const int sign = slope.sign()) return sign;
    }
    return 0;
  }

  /// The sign of det(from, to, point), or of det(along, to − from, point − from).
  int side_of(const glm::dvec3& point) const {
    if (const int sign = plane_.height(point).sign()) return sign;
    ExactSum volume;
    if (along_) {
      volume.add_volume(*along_, to_, point);
      volume.add_volume(*along_, from_, point, -1);
      volume.add_volume(*along_, from_, glm::dvec3(to_));
    } else {
      volume.add_volume(from_, to_, point);
    }
    return volume.sign();
  }

 private:
  Plane make_plane() const {
    const glm::dvec3 from(from_), to(to_);
    return along_ ? Plane(from, glm::dvec3(*along_), to - from) : Plane(glm::dvec3(0.0), from, to);
  }

  glm::vec3 from_, to_;
  const std::optional<glm::vec3>& along_;
  Plane plane_;
};

/// Whether there is a surface where light to a point meets a triangle that hides it.
bool is_there(const CutOuts& cut_outs, std::uint32_t triangle, const EdgePlane (&edges)[3],
              const glm::dvec3& point) {
  if (!cut_outs.has(triangle)) return true;
  // Each corner's weight is as the height over the plane of the edge across from it.
  glm::dvec3 weights;
  for (int corner = 0; corner < 3; ++corner)
    weights[corner] = edges[(corner + 1) % 3].plane().height(point).value;
  const double sum = weights.x + weights.y + weights.z;
  return sum == 0.0 || cut_outs.is_there(triangle, weights / sum);
}

}  // namespace

/// The point comes first.
struct SurfaceJudge::Cluster {
  static constexpr std::uint32_t k_all = (1u << k_points) - 1;
  std::array<glm::dvec3, k_points> points;
  std::uint32_t triangle;
  double step;  ///< at least what any coordinate of any point differs from the first's [m]
};

/// What is kept from point to point.
struct SurfaceJudge::Scratch {
  std::vector<std::uint32_t> found;
  std::optional<std::uint32_t> hider;  ///< the triangle that last hid a whole cluster
};

SurfaceJudge::SurfaceJudge(const Triangles& triangles, const scene::Light& light, const glm::dvec3& eye)
    : triangles_(triangles),
      eye_(scene::is_sun(light) ? glm::dvec3(0.0) : glm::dvec3(glm::vec3(eye - light.position))),
      vertices_(triangles.positions.size()),
      hierarchy_(triangles, scene::is_sun(light) ? eye : light.position) {
  const glm::dvec3 origin = scene::is_sun(light) ? eye : light.position;
  if (scene::is_sun(light)) along_ = -glm::vec3(scene::direction_to(light, eye));

  const glm::vec3 high(origin), low(origin - glm::dvec3(high));
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const glm::vec3& vertex = triangles.positions[i];
    vertices_[i] = (vertex - high) - low;
    const glm::dvec3 unrounded = glm::dvec3(vertex) - origin;
    largest_ = std::max({largest_, largest_of(unrounded), largest_of(glm::dvec3(vertices_[i]))});
    misplaced_ = std::max(misplaced_, largest_of(glm::dvec3(vertices_[i]) - unrounded));
  }

  // At equal steps of height, each turned from the one before by the golden angle: as even as so few can be.
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const double height =
        1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(directions_.size());
    const double azimuth = std::numbers::pi * (3.0 - std::sqrt(5.0)) * static_cast<double>(i);
    const double radius = std::sqrt(1.0 - height * height);
    directions_[i] = {radius * std::cos(azimuth), height, radius * std::sin(azimuth)};
  }
}

std::array<glm::vec3, 3> SurfaceJudge::corners(std::uint32_t triangle) const {
  const glm::uvec3& corner = triangles_.indices[triangle];
  return {vertices_[corner.x], vertices_[corner.y], vertices_[corner.z]};
}

double SurfaceJudge::rounding_of(std::uint32_t triangle) const {
  // A frame makes a point of three weights and three corners. The products and the sums of a coordinate are
  // rounded to 2⁻²⁴ of its terms, which are no larger than the largest corner's, and the weights, each
  // rounded, add up to 1 within 3 · 2⁻²⁴: together 6 of the 8 · 2⁻²⁴ that this has room for. An error of
  // weights that do add up to 1 moves the point about in its triangle, and is none.
  double largest = 0.0;
  for (const glm::vec3& corner : corners(triangle))
    largest = std::max(largest, largest_of(glm::dvec3(corner)));
  return 0x1p-21 * largest * std::numbers::sqrt3;
}

bool SurfaceJudge::faces(std::uint32_t triangle) const {
  const Face face = corners(triangle);
  const int eye_side = side_of(face, eye_);
  // Where a sun's light goes through the face, seen from its first corner, the sun is on the other side.
  const int light_side = along_ ? -EdgePlane(face[0], face[1], along_).side_of(glm::dvec3(face[2]))
                                : side_of(face, glm::dvec3(0.0));
  return eye_side * light_side >= 0;
}

bool SurfaceJudge::are_coplanar(std::uint32_t a, std::uint32_t b) const {
  const auto holds = [&](std::uint32_t plane_of_it, std::uint32_t other) {
    const glm::uvec3 &own = triangles_.indices[plane_of_it], &others = triangles_.indices[other];
    const auto& positions = triangles_.positions;
    const Face face{positions[own.x], positions[own.y], positions[own.z]};
    const Plane plane = plane_of(face);
    for (int i = 0; i < 3; ++i) {
      const bool is_shared = others[i] == own.x || others[i] == own.y || others[i] == own.z;
      if (!is_shared && side_of(face, plane, glm::dvec3(positions[others[i]])) != 0) return false;
    }
    return true;
  };
  // One way is enough, but that a triangle without area has no plane.
  return holds(a, b) && holds(b, a);
}

/// Bit i is set where light meets the triangle on its way to point i.
/// @param lit points to ask for
std::uint32_t SurfaceJudge::met_by(std::uint32_t triangle, Meets meets, const Cluster& cluster,
                                   std::uint32_t lit) const {
  const Face face = corners(triangle);
  const EdgePlane edges[3] = {
      {face[0], face[1], along_}, {face[1], face[2], along_}, {face[2], face[0], along_}};
  const int facing = edges[0].side_of(glm::dvec3(face[2]));
  if (facing == 0) return 0;

  // Most planes have the whole cluster on one side.
  enum class Side { within, beyond, unknown };
  const auto side_of_all = [&](const Plane& plane) {
    const auto [value, error] = plane.height(cluster.points[0]);
    const double margin = error + plane.change(cluster.step);
    return facing * value > margin ? Side::within : facing * value < -margin ? Side::beyond : Side::unknown;
  };
  Side sides[3];
  for (int i = 0; i < 3; ++i) {
    sides[i] = side_of_all(edges[i].plane());
    if (sides[i] == Side::beyond) return 0;
  }
  const Plane plane = plane_of(face);
  const Side side = side_of_all(plane);
  if (side == Side::beyond) return 0;
  if (triangle == cluster.triangle || are_coplanar(triangle, cluster.triangle)) return 0;

  const auto is_within = [&](const EdgePlane& edge, const glm::dvec3& point) {
    const int of_edge = facing * edge.side_of(point);
    return of_edge > 0 || (of_edge == 0 && (meets == Meets::touched || facing * edge.side_of_shift() > 0));
  };
  std::uint32_t met = 0;
  for (std::size_t i = 0; i < k_points; ++i) {
    if (!(lit >> i & 1u)) continue;
    const glm::dvec3& point = cluster.points[i];
    bool is_met = side == Side::within || facing * side_of(face, plane, point) > 0;
    for (int edge = 0; edge < 3 && is_met; ++edge)
      is_met = sides[edge] == Side::within || is_within(edges[edge], point);
    if (is_met && is_there(triangles_.cut_outs, triangle, edges, point)) met |= 1u << i;
  }
  return met;
}

/// What the triangle takes of the light to a point.
glm::uvec3 SurfaceJudge::attenuation(std::uint32_t triangle, const glm::dvec3& point) const {
  const scene::Attenuation& taken = triangles_.attenuations[triangle];
  if (!taken.grows_by_incidence) return taken.of_channel;
  const Face face = corners(triangle);
  const glm::dvec3 a(face[0]), ab = glm::dvec3(face[1]) - a, ac = glm::dvec3(face[2]) - a;
  const glm::dvec3 direction = along_ ? glm::dvec3(*along_) : point;
  const glm::dvec3 n = glm::cross(ab / largest_of(ab), ac / largest_of(ac));
  return scene::attenuation_at(taken, std::abs(glm::dot(glm::normalize(n), glm::normalize(direction))));
}

/// All through which light comes to the points of a cluster, relative to the light, or to the eye under a
/// sun.
Region SurfaceJudge::region_before(const Cluster& cluster) const {
  const glm::dvec3& point = cluster.points[0];
  const double largest = std::max(largest_, largest_of(point));
  // Light comes to the cluster's points next to the light ray of the first. Where it meets a triangle of the
  // frame, the hierarchy's is as close as its corners are. What is left is the rounding of doubles, to 2⁻⁵³
  // of the coordinates, in the region and in the search.
  const double margin = 1.01 * std::numbers::sqrt3 * (cluster.step + misplaced_) + 0x1p-45 * largest;

  Region region;
  const glm::dvec3 towards = along_ ? -glm::dvec3(*along_) : -point;
  for (int axis = 0; axis < 3; ++axis) {
    double lower = point[axis], upper = point[axis];
    if (along_) {
      if (towards[axis] > 0.0) upper = std::numeric_limits<double>::infinity();
      if (towards[axis] < 0.0) lower = -std::numeric_limits<double>::infinity();
    } else {
      lower = std::min(lower, 0.0);
      upper = std::max(upper, 0.0);
    }
    region.box.lower[axis] = lower - margin;
    region.box.upper[axis] = upper + margin;
  }

  const double length = largest_of(towards);
  if (length == 0.0) return region;
  const glm::dvec3 ray = glm::normalize(towards / length), steepness = glm::abs(ray);
  const int flattest = steepness.x <= steepness.y && steepness.x <= steepness.z ? 0
                       : steepness.y <= steepness.z                             ? 1
                                                                                : 2;
  glm::dvec3 axis(0.0);
  axis[flattest] = 1.0;
  const glm::dvec3 across = glm::normalize(glm::cross(ray, axis));
  for (const glm::dvec3& outward : {across, -across, glm::cross(ray, across), -glm::cross(ray, across)})
    region.cut({.inward = -outward, .origin = point + margin * outward});
  return region;
}

SurfaceVerdict SurfaceJudge::judge(const SurfacePoint& point, Scratch& scratch) const {
  constexpr SurfaceVerdict k_dark{Verdict::dark, true};
  const bool is_behind = !faces(point.triangle);
  if (is_behind && !triangles_.transmits(point.triangle)) return k_dark;

  Cluster cluster;
  cluster.triangle = point.triangle;
  const glm::dvec3 position(point.position);
  const double rounding = rounding_of(point.triangle);
  // A coordinate this small could have digits below 2⁻²⁰⁰ m, which no exact sum takes: it is taken for 0.
  constexpr double k_smallest = 0x1p-147;
  cluster.step = 1.01 * rounding + 0x1p-52 * largest_of(position) + k_smallest;
  cluster.points[0] = position;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    glm::dvec3 other = position + rounding * directions_[i];
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(other[axis]) < k_smallest) other[axis] = 0.0;
    }
    cluster.points[i + 1] = other;
  }

  // What hid the neighbour is likely to hide this one.
  if (scratch.hider && met_by(*scratch.hider, Meets::touched, cluster, Cluster::k_all) == Cluster::k_all)
    return k_dark;

  std::uint32_t lit = Cluster::k_all;
  std::array<glm::uvec3, k_points> taken{};
  const auto take = [&](std::uint32_t triangle, std::uint32_t points) {
    for (std::size_t i = 0; i < k_points; ++i) {
      if (!(points >> i & 1u)) continue;
      taken[i] = scene::add_attenuation(taken[i], attenuation(triangle, cluster.points[i]));
      if (taken[i] == glm::uvec3(scene::Attenuation::k_nothing_left)) lit &= ~(1u << i);
    }
  };
  hierarchy_.find(region_before(cluster), scratch.found);
  for (const std::uint32_t triangle : scratch.found) {
    if (triangles_.transmits(triangle)) {
      take(triangle, met_by(triangle, Meets::crossed, cluster, lit));
    } else {
      const std::uint32_t hidden = met_by(triangle, Meets::touched, cluster, lit);
      if (hidden == Cluster::k_all) scratch.hider = triangle;
      lit &= ~hidden;
    }
    if (lit == 0) return k_dark;
  }
  if (is_behind) take(point.triangle, lit);
  if (!(lit & 1u)) return {Verdict::dark, lit == 0};
  // Neighbours in one plane take the same but for the rounding of the angle under which light falls on them.
  constexpr double k_alike = 0x1p-10;
  const glm::dvec3 share = scene::share_left(taken[0]);
  const bool is_decided =
      lit == Cluster::k_all && std::all_of(taken.begin(), taken.end(), [&](glm::uvec3 other) {
        return glm::all(glm::lessThan(glm::abs(scene::share_left(other) - share), glm::dvec3(k_alike)));
      });
  return {Verdict::lit, is_decided, glm::vec3(share)};
}

SurfaceVerdict SurfaceJudge::judge(const SurfacePoint& point) const {
  Scratch scratch;
  return judge(point, scratch);
}

std::vector<SurfaceVerdict> SurfaceJudge::judge(std::span<const SurfacePoint> points) const {
  std::vector<SurfaceVerdict> verdicts(points.size());
  const auto parts = static_cast<int>((points.size() + k_part - 1) / k_part);
  scene::parallel(parts,
                  [&] {
                    return [&, scratch = Scratch()](int part) mutable {
                      const std::size_t from = static_cast<std::size_t>(part) * k_part;
                      const std::size_t to = std::min(from + k_part, points.size());
                      for (std::size_t i = from; i < to; ++i) verdicts[i] = judge(points[i], scratch);
                    };
                  },
                  {});
  return verdicts;
}

}  // namespace airlight::reference
