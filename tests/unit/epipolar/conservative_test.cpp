#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "epipolar/space.h"
#include "scene/import.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/shared.h"

/// shaders/epipolar/conservative.glsl, triangle by triangle, so that none hides behind another: whatever
/// point of a triangle one picks, in double precision, its light ray is noted at its cell of α or before.
namespace airlight::epipolar {
namespace {

using shaders::EpipolarBlock;
using shaders::PhiCells;
using std::numbers::pi;

/// What voxelizing single triangles notes, by light ray.
class Voxels {
 public:
  Voxels(const scene::View& view, const Resolution& n, Ranges ranges, double phi_max)
      : n_(n),
        eye_(view.camera.eye),
        distance_(glm::distance(view.lights[0].position, eye_)),
        axes_(make_axes((view.lights[0].position - eye_) / distance_)),
        space_(epipolar_block(view, view.lights[0], n, ranges, ThetaCells::fitted)),
        cells_{static_cast<float>(phi_max), 1.5f, static_cast<float>(n.phi)},
        first_(static_cast<std::size_t>(n.theta) * static_cast<std::size_t>(n.phi)),
        stamp_(first_.size()) {}

  /// As the compute shaders do.
  void voxelize(const std::array<glm::dvec3, 3>& corners) {
    ++current_;
    const auto alpha_count = static_cast<std::uint32_t>(n_.alpha);
    const auto relative = [&](std::size_t i) { return glm::vec3(corners[i] - eye_); };
    const shaders::VoxelTriangle triangle = shaders::voxel_triangle(
        space_, relative(0), relative(1), relative(2), static_cast<std::uint32_t>(n_.theta));
    for (std::uint32_t index = 0; index < shaders::plane_count(triangle.planes); ++index) {
      const std::uint32_t plane = shaders::plane_at(triangle.planes, index);
      const float border = shaders::theta_of_plane(space_, static_cast<float>(plane));
      const std::uint32_t slabs = shaders::slabs_per_plane(space_);
      const float step = (shaders::theta_of_plane(space_, static_cast<float>(plane + 1)) - border) /
                         static_cast<float>(slabs);
      for (std::uint32_t slab = 0; slab < slabs; ++slab) {
        const float from_theta = border + static_cast<float>(slab) * step;
        const shaders::SlabPart part =
            shaders::part_in_slab(space_, cells_, triangle, from_theta, from_theta + step);
        glm::vec2 from = shaders::boundary_ray(cells_, part.first_ray);
        for (std::uint32_t k = part.first_ray; k < part.end_ray; ++k) {
          const glm::vec2 to = shaders::boundary_ray(cells_, k + 1);
          const std::uint32_t first = shaders::first_touched_cell(space_, part, from, to, alpha_count);
          if (first < alpha_count) note(plane, k, first);
          from = to;
        }
      }
    }
  }

  /// A cell of the grid, as real numbers.
  struct Place {
    double alpha, theta, phi;  ///< [cells]
  };

  /// Whether the grid covers a point, and where.
  bool place_of(glm::dvec3 point, Place& place) const {
    const glm::dvec3 p = point - eye_;
    const double x = glm::dot(p, axes_.u), y = glm::dot(p, axes_.f), z = glm::dot(p, axes_.axis);
    const double rho = std::hypot(x, y);
    const double phi = std::atan2(rho, distance_ - z), phi_max = static_cast<double>(cells_.phi_max);
    const double growth = static_cast<double>(cells_.growth), q = (1 + growth) * phi / phi_max;
    place.phi = n_.phi * 2 * q / (1 + std::sqrt(1 + 4 * growth * q));
    place.alpha =
        (std::atan2(rho, z) - static_cast<double>(space_.alpha_min)) / static_cast<double>(space_.alpha_step);
    const double from_middle =
        std::remainder(std::atan2(y, x) - static_cast<double>(space_.theta_middle), 2 * pi);
    place.theta = (from_middle + static_cast<double>(space_.theta_growth) * std::sin(from_middle) +
                   static_cast<double>(space_.theta_half)) /
                  static_cast<double>(space_.theta_step);
    return rho > 0 && place.alpha < n_.alpha && place.theta >= 0 && place.theta < n_.theta &&
           place.phi >= 0 && place.phi < n_.phi;
  }

  bool holds(const Place& place) const {
    return at(static_cast<std::uint32_t>(place.theta), static_cast<std::uint32_t>(place.phi)) <=
           static_cast<std::uint32_t>(std::max(place.alpha, 0.0));
  }

  /// The cell noted by the current triangle.
  std::uint32_t at(std::uint32_t plane, std::uint32_t k) const {
    const std::size_t ray = std::size_t{plane} * static_cast<std::size_t>(n_.phi) + k;
    return stamp_[ray] == current_ ? first_[ray] : std::numeric_limits<std::uint32_t>::max();
  }

  std::size_t noted() const { return noted_; }  ///< light rays, over all triangles
  const Resolution& resolution() const { return n_; }

 private:
  void note(std::uint32_t plane, std::uint32_t k, std::uint32_t first) {
    const std::size_t ray = std::size_t{plane} * static_cast<std::size_t>(n_.phi) + k;
    noted_ += stamp_[ray] == current_ ? 0 : 1;
    first_[ray] = stamp_[ray] == current_ ? std::min(first_[ray], first) : first;
    stamp_[ray] = current_;
  }

  Resolution n_;
  glm::dvec3 eye_;
  double distance_;
  Axes axes_;
  EpipolarBlock space_;
  PhiCells cells_;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> stamp_;
  std::uint32_t current_ = 0;
  std::size_t noted_ = 0;
};

std::array<glm::dvec3, 3> corners_of(const scene::Geometry& geometry, glm::uvec3 triangle) {
  return {glm::dvec3(geometry.positions[triangle.x]), glm::dvec3(geometry.positions[triangle.y]),
          glm::dvec3(geometry.positions[triangle.z])};
}

/// A point of a triangle: a corner, on an edge, or inside, in turn.
glm::dvec3 pick(const std::array<glm::dvec3, 3>& corners, int sample, tests::Random& random) {
  if (sample < 3) return corners[static_cast<std::size_t>(sample)];
  double a = random.uniform(), b = random.uniform();
  if (a + b > 1) {
    a = 1 - a;
    b = 1 - b;
  }
  if (sample % 2 == 1) (sample % 4 == 1 ? a : b) = sample % 8 < 4 ? 0.0 : 1 - (sample % 4 == 1 ? b : a);
  return corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]);
}

struct Count {
  std::size_t points = 0, missed = 0;
};

/// Voxelizes every triangle by itself and looks for `samples` of its points.
Count look_for_points(const scene::Geometry& geometry, Voxels& voxels, int samples) {
  Count count;
  tests::Random random(3);
  for (const glm::uvec3 triangle : geometry.triangles) {
    const auto corners = corners_of(geometry, triangle);
    voxels.voxelize(corners);
    for (int sample = 0; sample < samples; ++sample) {
      Voxels::Place place{};
      if (!voxels.place_of(pick(corners, sample, random), place)) continue;
      ++count.points;
      count.missed += voxels.holds(place) ? 0 : 1;
    }
  }
  return count;
}

scene::View view_between(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 light, double fov = 60) {
  scene::View view;
  view.camera.eye = eye;
  view.camera.target = target;
  view.camera.vertical_fov_degrees = fov;
  view.lights[0].position = light;
  view.size = {64, 64};
  return view;
}

constexpr Resolution k_coarse{64, 256, 128};

void expect_every_point_found(const scene::Geometry& geometry, const scene::View& view, Ranges ranges,
                              int samples, const Resolution& n = k_coarse, double phi_max = pi) {
  Voxels voxels(view, n, ranges, phi_max);
  const Count count = look_for_points(geometry, voxels, samples);
  testing::Test::RecordProperty("points", static_cast<int>(count.points));
  EXPECT_GT(count.points, 0u);
  EXPECT_EQ(count.missed, 0u) << "of " << count.points;
}

struct Model {
  const char* name;
  glm::dvec3 eye, target, light;
};

void PrintTo(const Model& model, std::ostream* stream) {
  *stream << model.name;
}

class ConservativeModel : public testing::TestWithParam<Model> {};

TEST_P(ConservativeModel, EveryPointOfEveryTriangleIsInAVoxelOfItsOwn) {
  const Model& model = GetParam();
  const auto file = tests::shared_file(std::string("scenes/") + model.name + ".glb");
  AIRLIGHT_NEEDS(file);
  const scene::Scene scene = scene::import_scene(file);
  expect_every_point_found(scene.geometry, view_between(model.eye, model.target, model.light), Ranges::frame,
                           11);
  // The light behind the camera, and so a short range of φ.
  expect_every_point_found(scene.geometry,
                           view_between(model.light, 2.0 * model.light - model.eye, model.eye),
                           Ranges::alpha_phi, 7, k_coarse, 1.0);
}

INSTANTIATE_TEST_SUITE_P(
    Shared, ConservativeModel,
    testing::Values(Model{"victorian_fence_19k", {0.3, 0.5, 3}, {0, 0.4, 0}, {-0.2, 0.7, -1}},
                    Model{"maple_198k", {-2, 2, 11}, {0.5, 3.8, 0}, {1.5, 5, -5}},
                    Model{"railing_degenerate_11k", {0.3, 0.5, 3}, {0, 0.4, 0}, {-0.2, 0.7, -1}},
                    Model{"sponza_262k", {-12, 3, -0.5}, {0, 5, 0}, {3, 7, 0}}));

/// Triangles of many sizes and shapes about eye and light.
scene::Geometry random_soup(int triangles, double largest, std::uint32_t seed) {
  tests::Random random(seed);
  scene::Geometry soup;
  for (int i = 0; i < triangles; ++i) {
    const glm::dvec3 middle = random.in_box(6.0);
    const double size = random.logarithmic(1e-5, largest),
                 thin = i % 3 == 0 ? random.logarithmic(1e-6, 1.0) : 1;
    const glm::dvec3 along = size * random.direction();
    tests::add_triangle(soup, glm::vec3(middle), glm::vec3(middle + along),
                        glm::vec3(middle + 0.5 * along + thin * size * random.direction()));
  }
  return soup;
}

class ConservativeSoup : public testing::TestWithParam<Resolution> {};

TEST_P(ConservativeSoup, EveryPointIsFound) {
  for (const Ranges ranges : {Ranges::full, Ranges::frame}) {
    const glm::dvec3 eye(0.4, -0.3, 3.0), light(-0.5, 0.6, -1.0);
    expect_every_point_found(random_soup(1500, 20.0, 1), view_between(eye, light, light), ranges, 40,
                             GetParam());
    expect_every_point_found(random_soup(500, 20.0, 2), view_between(eye, {3, 0, 3.5}, light), ranges, 40,
                             GetParam());
    expect_every_point_found(random_soup(500, 20.0, 3), view_between(eye, eye + eye - light, light), ranges,
                             40, GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(Resolutions, ConservativeSoup,
                         testing::Values(Resolution{1, 1, 128}, Resolution{64, 3, 128},
                                         Resolution{64, 256, 128}, Resolution{256, 777, 256}));

TEST(ConservativeTriangle, AboutTheEpipoleIsInEveryPlane) {
  // Figs. 9 and 10: triangles that hold the axis, or the eye's or the light's neighbourhood, or touch θ = ±π.
  const glm::dvec3 eye(0.0), light(0.0, 0.0, 4.0);
  const scene::View view = view_between(eye, light, light);
  const auto across = [](double z, double size, glm::dvec2 offset) {
    scene::Geometry geometry;
    tests::add_triangle(geometry, {offset.x - size, offset.y - size, z},
                        {offset.x + size, offset.y - size, z}, {offset.x, offset.y + 2 * size, z});
    return geometry;
  };
  for (const double z : {-3.0, -1e-3, 1e-3, 2.0, 3.999, 4.001, 6.0}) {
    for (const double size : {1e-4, 1e-2, 1.0, 50.0}) {
      for (const glm::dvec2 offset : {glm::dvec2(0.0), glm::dvec2(0.0, 0.3), glm::dvec2(1.0, 0.0) * size}) {
        expect_every_point_found(across(z, size, offset), view, Ranges::full, 2000);
      }
    }
  }
  Voxels voxels(view, k_coarse, Ranges::full, pi);
  const scene::Geometry epipole = across(2.0, 1e-3, {0.0, 0.0});
  voxels.voxelize(corners_of(epipole, epipole.triangles[0]));
  for (std::uint32_t plane = 0; plane < 256; ++plane) EXPECT_EQ(voxels.at(plane, 0), 0u) << plane;
}

TEST(ConservativeTriangle, ThinnerThanAVoxelLeavesNoGap) {
  // A needle of a millionth of its length, through many cells.
  const scene::View view = view_between({0.0, 0.0, 0.0}, {0.0, 0.0, 4.0}, {0.0, 0.0, 4.0});
  scene::Geometry needle;
  tests::add_triangle(needle, {-3.0f, 0.5f, 1.0f}, {3.0f, 0.7f, 3.0f}, {3.0f, 0.700003f, 3.0f});
  expect_every_point_found(needle, view, Ranges::full, 20000, {256, 777, 256});
}

TEST(ConservativeTriangle, IsNotMuchTooFat) {
  // Light rays noted but by no point of a dense sample touched. Slabs are exact but for their slack; what is
  // left are cells that a triangle touches by less than the sample is dense.
  const scene::View view = view_between({0.4, -0.3, 3.0}, {-0.5, 0.6, -1.0}, {-0.5, 0.6, -1.0});
  const Resolution n{256, 777, 256};
  Voxels voxels(view, n, Ranges::full, pi);
  const scene::Geometry soup = random_soup(300, 1.0, 4);
  tests::Random random(5);
  std::size_t touched = 0, first_cells = 0, too_near = 0;
  for (const glm::uvec3 triangle : soup.triangles) {
    const auto corners = corners_of(soup, triangle);
    const std::size_t before = voxels.noted();
    voxels.voxelize(corners);
    const std::size_t samples = std::min<std::size_t>(2000000, 300 * (voxels.noted() - before) + 1000);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> nearest;
    for (std::size_t i = 0; i < samples; ++i) {
      Voxels::Place place{};
      if (!voxels.place_of(pick(corners, static_cast<int>(i % 64), random), place)) continue;
      const auto cell = static_cast<std::uint32_t>(std::max(place.alpha, 0.0));
      const auto [entry, is_new] = nearest.try_emplace(
          {static_cast<std::uint32_t>(place.theta), static_cast<std::uint32_t>(place.phi)}, cell);
      if (!is_new) entry->second = std::min(entry->second, cell);
    }
    touched += nearest.size();
    for (const auto& [ray, cell] : nearest) {
      first_cells += cell;
      too_near += cell - std::min(cell, voxels.at(ray.first, ray.second));
    }
  }
  const double excess = static_cast<double>(voxels.noted()) / static_cast<double>(touched) - 1;
  RecordProperty("excess_rays_percent", std::to_string(100 * excess));
  RecordProperty("cells_too_near_a_ray",
                 std::to_string(static_cast<double>(too_near) / static_cast<double>(touched)));
  EXPECT_LT(excess, 0.05);
  EXPECT_LT(too_near, touched / 20);
}

}  // namespace
}  // namespace airlight::epipolar
