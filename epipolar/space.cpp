#include "epipolar/space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace airlight::epipolar {
namespace {

double angle_between(glm::dvec3 a, glm::dvec3 b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

bool in_image(const scene::CameraFrame& camera, glm::dvec3 direction) {
  const double depth = glm::dot(direction, camera.forward);
  return depth > 0.0 && std::abs(glm::dot(direction, camera.right)) <= camera.half_width * depth &&
         std::abs(glm::dot(direction, camera.up)) <= camera.half_height * depth;
}

}  // namespace

Axes make_axes(glm::dvec3 l) {
  if (l.y < -1.0 + 1e-12) return {l, {0.0, 0.0, -1.0}, {1.0, 0.0, 0.0}};
  const double a = 1.0 / (1.0 + l.y);
  const double b = -l.z * l.x * a;
  return {l, {b, -l.z, 1.0 - l.z * l.z * a}, {1.0 - l.x * l.x * a, -l.x, b}};
}

Range alpha_range(const scene::CameraFrame& camera, glm::dvec3 axis) {
  using std::numbers::pi;
  Range range{pi, 0.0};
  const auto include = [&](glm::dvec3 ray) {
    const double angle = angle_between(axis, ray);
    range.lower = std::min(range.lower, angle);
    range.upper = std::max(range.upper, angle);
  };
  const std::array<glm::dvec3, 4> corners = scene::corner_rays(camera);
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 a = corners[i], edge = corners[(i + 1) % 4] - a;
    include(a);
    // The cosine dot(l, a + s·edge) / |a + s·edge| is stationary where
    // dot(l, edge)·dot(p, p) = dot(l, p)·dot(p, edge), p = a + s·edge; the terms in s² cancel.
    const double la = glm::dot(axis, a), le = glm::dot(axis, edge);
    const double aa = glm::dot(a, a), ae = glm::dot(a, edge), ee = glm::dot(edge, edge);
    const double slope = le * ae - la * ee;
    if (slope == 0.0) continue;
    const double s = (la * ae - le * aa) / slope;
    if (s > 0.0 && s < 1.0) include(a + s * edge);
  }
  if (in_image(camera, axis)) range.lower = 0.0;
  if (in_image(camera, -axis)) range.upper = pi;
  return range;
}

Range theta_range(const scene::CameraFrame& camera, const Axes& axes) {
  using std::numbers::pi;
  if (in_image(camera, axes.axis) || in_image(camera, -axes.axis)) return {-pi, pi};
  // Seen along the axis the image is a convex cone that does not hold the origin: it spans less than π, its
  // extremes are corners, and all are within π of its inside.
  const auto theta = [&](glm::dvec3 ray) { return std::atan2(glm::dot(ray, axes.f), glm::dot(ray, axes.u)); };
  const double inside = theta(camera.forward);
  Range range{0.0, 0.0};
  for (const glm::dvec3& corner : scene::corner_rays(camera)) {
    const double from_inside = std::remainder(theta(corner) - inside, 2.0 * pi);
    range.lower = std::min(range.lower, from_inside);
    range.upper = std::max(range.upper, from_inside);
  }
  return {inside + range.lower, inside + range.upper};
}

namespace {

/// The planes of a frame.
struct ThetaSpacing {
  double middle, half;
  double growth;  ///< see EpipolarBlock
};

/// How far apart, in pixels, two planes a radian apart are on the image's border, the farthest that their
/// rays reach; by equal steps of θ over a turn.
std::vector<double> reach_of_planes(const scene::CameraFrame& camera, glm::ivec2 size, const Axes& axes) {
  constexpr int k_bins = 256, k_points = 1024;
  std::vector<double> reach(k_bins, 0.0);
  const auto include = [&](double x, double y) {
    const glm::dvec3 point = scene::image_ray(camera, {x, y});
    const double turn =
        std::atan2(glm::dot(point, axes.f), glm::dot(point, axes.u)) / (2.0 * std::numbers::pi);
    const auto bin = static_cast<std::size_t>((turn - std::floor(turn)) * k_bins) % k_bins;
    // A pixel seen off the axis spans less: its size over the length of the ray, foreshortened.
    const double pixel = 2.0 * camera.half_height / size.y / glm::dot(point, point);
    reach[bin] = std::max(reach[bin], glm::length(glm::cross(axes.axis, glm::normalize(point))) / pixel);
  };
  for (int i = 0; i <= k_points; ++i) {
    const double s = 2.0 * i / k_points - 1.0;
    include(s, -1.0);
    include(s, 1.0);
    include(-1.0, s);
    include(1.0, s);
  }
  return reach;
}

double angle_of_bin(std::size_t bin, std::size_t bins) {
  return 2.0 * std::numbers::pi * (static_cast<double>(bin) + 0.5) / static_cast<double>(bins);
}

/// Edges of shadow are displaced by up to half the distance of planes, so the squared error of a pixel is
/// proportional to it, and a plane's to (reach)³ / density over its pixels. Of densities 1 + g cos(θ − θ_m)
/// the one with the least sum is taken.
ThetaSpacing theta_spacing(const scene::View& view, const scene::CameraFrame& camera, const Axes& axes,
                           Ranges ranges, ThetaCells theta_cells) {
  using std::numbers::pi;
  const Range theta = ranges == Ranges::frame ? theta_range(camera, axes) : Range{-pi, pi};
  ThetaSpacing spacing{std::remainder(0.5 * (theta.lower + theta.upper), 2.0 * pi),
                       0.5 * (theta.upper - theta.lower), 0.0};
  if (theta_cells == ThetaCells::equal || ranges != Ranges::frame || spacing.half <= pi - 1e-9)
    return spacing;

  const std::vector<double> reach = reach_of_planes(camera, view.size, axes);
  double along_u = 0.0, along_f = 0.0;
  for (std::size_t bin = 0; bin < reach.size(); ++bin) {
    const double weight = std::pow(reach[bin], 1.5), angle = angle_of_bin(bin, reach.size());
    along_u += weight * std::cos(angle);
    along_f += weight * std::sin(angle);
  }
  spacing.middle = std::atan2(along_f, along_u);
  double least = std::numeric_limits<double>::infinity();
  constexpr int k_steps = 16;
  for (int step = 0; step <= k_steps; ++step) {
    const double growth = k_most_theta_growth * step / k_steps;
    double sum = 0.0;
    for (std::size_t bin = 0; bin < reach.size(); ++bin) {
      sum += reach[bin] * reach[bin] * reach[bin] /
             (1.0 + growth * std::cos(angle_of_bin(bin, reach.size()) - spacing.middle));
    }
    if (sum < least) {
      least = sum;
      spacing.growth = growth;
    }
  }
  return spacing;
}

Axes axes_of(const scene::View& view, const scene::Light& light) {
  return make_axes(scene::direction_to(light, view.camera.eye));
}

Range alpha_of_grid(const scene::CameraFrame& camera, const Axes& axes, Ranges ranges) {
  return ranges == Ranges::full ? Range{0.0, std::numbers::pi} : alpha_range(camera, axes.axis);
}

/// EpipolarBlock::alpha_spacing.
float spacing_of_alpha(const Range& alpha, Ranges ranges) {
  if (ranges != Ranges::frame) return shaders::k_equal_alpha;
  if (alpha.lower == 0.0) return shaders::k_root_of_alpha;
  return alpha.upper == std::numbers::pi ? shaders::k_root_of_complement : shaders::k_equal_alpha;
}

}  // namespace

shaders::EpipolarBlock epipolar_block(const scene::View& view, const scene::Light& light,
                                      const Resolution& resolution, Ranges ranges, ThetaCells theta_cells) {
  const Axes axes = axes_of(view, light);
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  const Range alpha = alpha_of_grid(camera, axes, ranges);
  const ThetaSpacing theta = theta_spacing(view, camera, axes, ranges, theta_cells);
  shaders::EpipolarBlock block{};
  block.axis = glm::vec3(axes.axis);
  if (!scene::is_sun(light)) {
    const double distance = glm::distance(light.position, view.camera.eye);
    block.distance = static_cast<float>(distance);
    block.inverse_distance = static_cast<float>(1.0 / distance);
  }
  block.own_ranges = ranges == Ranges::frame ? 1.0f : 0.0f;
  block.u = glm::vec3(axes.u);
  block.f = glm::vec3(axes.f);
  block.alpha_min = shaders::Angle(static_cast<float>(alpha.lower));
  block.alpha_spacing = spacing_of_alpha(alpha, ranges);
  block.alpha_step = shaders::spaced_alpha(block, shaders::Angle(static_cast<float>(alpha.upper))) /
                     static_cast<float>(resolution.alpha);
  block.theta_middle = shaders::Angle(static_cast<float>(theta.middle));
  block.theta_half = shaders::Angle(static_cast<float>(theta.half));
  block.theta_step = shaders::Angle(static_cast<float>(2.0 * theta.half / resolution.theta));
  block.theta_growth = static_cast<float>(theta.growth);
  return block;
}

namespace {

/// The φ of what is known of a convex body, or of a part of it.
struct PhiBounds {
  double lower = std::numeric_limits<double>::infinity(), upper = 0.0;
  void include(double phi) {
    lower = std::min(lower, phi);
    upper = std::max(upper, phi);
  }
  void include(const PhiBounds& other) {
    lower = std::min(lower, other.lower);
    upper = std::max(upper, other.upper);
  }
};

}  // namespace

std::vector<glm::vec2> box_ranges(const scene::Box& box, glm::dvec3 eye, const shaders::EpipolarBlock& block,
                                  int theta_count) {
  using std::numbers::pi;
  std::vector<glm::vec2> ranges(static_cast<std::size_t>(theta_count), glm::vec2(0.0f));
  if (box.empty()) return ranges;
  const bool is_sun = shaders::is_sun(block);
  const double distance = static_cast<double>(block.distance);
  const auto phi_of = [&](double across, double z) {
    return is_sun ? across : std::atan2(across, distance - z);
  };

  // The box along u, f and the axis. A face's slack covers what single precision makes of it.
  const glm::dvec3 u(block.u), f(block.f), axis(block.axis);
  const glm::dvec3 lower = glm::dvec3(box.lower) - eye, upper = glm::dvec3(box.upper) - eye;
  const glm::dvec3 slack(1e-5 * (glm::length(lower) + glm::length(upper)));
  std::array<glm::dvec3, 8> corners;
  std::array<double, 8> theta_of_corner{}, phi_of_corner{};
  for (std::size_t i = 0; i < 8; ++i) {
    const glm::dvec3 side(i & 1, i >> 1 & 1, i >> 2);
    const glm::dvec3 corner = glm::mix(lower - slack, upper + slack, side);
    const glm::dvec3& p = corners[i] = {glm::dot(corner, u), glm::dot(corner, f), glm::dot(corner, axis)};
    theta_of_corner[i] = std::atan2(p.y, p.x);
    phi_of_corner[i] = phi_of(std::hypot(p.x, p.y), p.z);
  }

  // Where the axis goes through the box, every half-plane begins there, at φ = 0, or, beyond the light, at π.
  PhiBounds of_axis;
  double enters = -std::numeric_limits<double>::infinity(), leaves = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double from = (lower[i] - slack[i]) / axis[i], to = (upper[i] + slack[i]) / axis[i];
    if (axis[i] == 0.0) {
      if (lower[i] > slack[i] || upper[i] < -slack[i]) leaves = -std::numeric_limits<double>::infinity();
      continue;
    }
    enters = std::max(enters, std::min(from, to));
    leaves = std::min(leaves, std::max(from, to));
  }
  if (enters <= leaves) {
    if (is_sun || enters <= distance) of_axis.include(0.0);
    if (!is_sun && leaves >= distance) of_axis.include(pi);
  }

  // Where a half-plane cuts the box, φ is extreme at a corner of the section: where it cuts an edge, or on
  // the axis.
  const auto section = [&](double theta) {
    PhiBounds bounds = of_axis;
    const double cosine = std::cos(theta), sine = std::sin(theta);
    for (std::size_t i = 0; i < 8; ++i) {
      for (std::size_t bit = 1; bit < 8; bit *= 2) {
        if (i & bit) continue;
        const glm::dvec3 &p = corners[i], &q = corners[i | bit];
        const double side_p = p.y * cosine - p.x * sine, side_q = q.y * cosine - q.x * sine;
        if ((side_p < 0.0) == (side_q < 0.0)) continue;
        const glm::dvec3 point = p + side_p / (side_p - side_q) * (q - p);
        const double across = point.x * cosine + point.y * sine;
        if (across >= 0.0) bounds.include(phi_of(across, point.z));
      }
    }
    return bounds;
  };
  const auto border = [&](int j) {
    return static_cast<double>(shaders::theta_of_plane(block, shaders::Cell(static_cast<float>(j))));
  };
  const auto middle = static_cast<double>(block.theta_middle);
  double to = border(0);
  PhiBounds at_border = section(middle + to);
  for (int j = 0; j < theta_count; ++j) {
    // Of the cell: what its borders' sections, its middle's and the corners between them have.
    const double from = std::exchange(to, border(j + 1));
    PhiBounds bounds = at_border;
    bounds.include(section(middle + 0.5 * (from + to)));
    at_border = section(middle + to);
    bounds.include(at_border);
    for (std::size_t i = 0; i < 8; ++i) {
      const double theta = std::remainder(theta_of_corner[i] - middle - 0.5 * (from + to), 2.0 * pi);
      if (std::abs(theta) <= 0.5 * (to - from) * 1.0001) bounds.include(phi_of_corner[i]);
    }
    if (bounds.lower > bounds.upper) continue;
    // Between two sections a straight edge comes nearer to the axis than where they cut it, by the cosine of
    // the angle between them; a point's light rays beyond a right angle nearer to its other side.
    const double shrink = std::cos(std::min(to - from, 0.5 * pi)) * (1.0 - 1e-6);
    const double above =
        is_sun || bounds.upper < 0.5 * pi ? bounds.upper * (1.0 + 1e-6) : pi - (pi - bounds.upper) * shrink;
    ranges[static_cast<std::size_t>(j)] = glm::vec2(bounds.lower * shrink, above);
  }
  return ranges;
}

Resolution pixel_exact(const scene::View& view, const scene::Light& light, Ranges ranges,
                       ThetaCells theta_cells) {
  const Axes axes = axes_of(view, light);
  const scene::CameraFrame camera = scene::camera_frame(view.camera, view.size);
  const Range alpha = alpha_of_grid(camera, axes, ranges);
  const double corner = 1.0 + camera.half_width * camera.half_width + camera.half_height * camera.half_height;
  const double least_pixel = 2.0 * camera.half_height / view.size.y / corner;
  Resolution resolution;
  // Cells that are equal in a root are at its far end twice as wide as all are in the mean.
  const double widest = spacing_of_alpha(alpha, ranges) == shaders::k_equal_alpha ? 1.0 : 2.0;
  resolution.alpha = static_cast<int>(std::ceil(widest * (alpha.upper - alpha.lower) / least_pixel));
  const ThetaSpacing theta = theta_spacing(view, camera, axes, ranges, theta_cells);
  const std::vector<double> reach = reach_of_planes(camera, view.size, axes);
  double planes = 1.0;
  for (std::size_t bin = 0; bin < reach.size(); ++bin) {
    const double density = 1.0 + theta.growth * std::cos(angle_of_bin(bin, reach.size()) - theta.middle);
    planes = std::max(planes, 2.0 * theta.half * reach[bin] / density);
  }
  resolution.theta = static_cast<int>(std::ceil(planes));
  return resolution;
}

}  // namespace airlight::epipolar
