#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "scene/builtin_internal.h"

// A ring of seven saddles about a lamp, of the family of the heptagonal toroid that papers on shadows show.
//
// Based on: Carlo H. Séquin, Virtual Prototyping of Scherk-Collins Saddle Rings, Leonardo 30(2), 1997: a
// tower of Scherk's saddles, twisted and bent into a ring. In a cross section of the ring with polar
// coordinates (r, φ), at the angle θ along the ring, the sheet is the surface
//
//     (r / waist)ⁿ cos(n φ − 7θ/2) = cos(7θ/2),    r ≤ radius,
//
// where n is the order of the saddles; the power stands for Scherk's hyperbolic sines, which it follows near
// the core. A turn by 2π/7 swaps the sides of the sheet and leaves it where it is. Straight lines (cos 7θ/2 =
// 0) cut it into 7n patches, on each of which r and θ are coordinates. With n = 3 the solid has genus 15.

namespace airlight::scene {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr int k_storeys = 7;
constexpr int k_order = 3;
constexpr double k_ring = 1.8, k_radius = 1.15, k_waist = 0.62;  // [m]
constexpr double k_half_thickness = 0.055;                       // [m]
constexpr std::size_t k_rim_rows = 4;

/// Along the ring by an angle.
glm::dvec3 turned(glm::dvec3 p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x - s * p.z, p.y, s * p.x + c * p.z};
}

struct SheetPoint {
  glm::dvec3 position, normal, outward;  ///< outward: along the sheet, away from the ring's core
};

/// @param u across a patch, from one rim (−1) to the other (1)
/// @param v along the ring, from one straight line (−1) to the next (1)
SheetPoint sheet_point(double patch, double u, double v) {
  const double zeta = 0.5 * k_pi * v, theta = 2.0 * zeta / k_storeys;
  const double waist = k_waist * std::pow(std::max(std::cos(zeta), 0.0), 1.0 / k_order);
  const double r = std::sqrt(waist * waist + (k_radius * k_radius - waist * waist) * u * u);
  const double slope = r > 0.0 ? std::pow(waist / r, k_order) : 0.0;
  const double turn = std::copysign(std::acos(std::min(slope, 1.0)), u) / k_order;
  const double phi = 2.0 * k_pi * patch / k_order + turn + zeta / k_order;

  // In the frame (away from the ring's axis, up, along the ring).
  const glm::dvec3 radial(std::cos(phi), std::sin(phi), 0.0);
  const double reach = std::pow(r / k_waist, k_order - 1);
  const std::complex<double> w = std::polar(reach * r / k_waist, k_order * phi - zeta);
  const std::complex<double> slopes = std::polar(k_order * reach / k_waist, (k_order - 1) * phi - zeta);
  const glm::dvec3 gradient(slopes.real(), -slopes.imag(),
                            0.5 * k_storeys * (w.imag() + std::sin(zeta)) / (k_ring + r * radial.x));
  const glm::dvec3 normal = glm::normalize(gradient);
  const glm::dvec3 outward = glm::normalize(radial - glm::dot(radial, normal) * normal);

  return {turned(glm::dvec3(k_ring, 0.0, 0.0) + r * radial, theta), turned(normal, theta),
          turned(outward, theta)};
}

}  // namespace

Scene make_toroid(std::size_t triangles) {
  Scene scene;
  scene.name = "toroid";
  Modeller model(scene.geometry);
  model.paint({0.62f, 0.5f, 0.36f});

  // The grid of a patch, about as many rows as columns.
  const double wanted = static_cast<double>(triangles) / (4.0 * k_storeys * k_order);
  const auto half =
      static_cast<std::size_t>(std::max(1.0, std::round(0.5 * (std::sqrt(wanted + 4.0) - 2.0))));
  const std::size_t columns = 2 * half;
  const auto rows =
      static_cast<std::size_t>(std::max(2.0, std::round(wanted / static_cast<double>(columns + k_rim_rows))));

  // Where a grid point of a patch is kept. Those of the first row belong to its storey and those of the last
  // one to the next, where the sheet's sides have changed places; both rows are straight lines through the
  // core.
  struct Place {
    std::size_t storey, point, rim;
    bool is_swapped;
  };
  constexpr std::size_t k_lines = 2 * k_order;
  const auto place = [&](std::size_t storey, std::size_t patch, std::size_t row,
                         std::size_t column) -> Place {
    const bool is_last = row == rows;
    if (is_last) storey = (storey + 1) % k_storeys;
    if (row > 0 && !is_last) {
      return {storey, 1 + k_lines * half + (patch * (rows - 1) + row - 1) * (columns + 1) + column,
              k_lines + (2 * patch + (column > 0)) * (rows - 1) + row - 1, false};
    }
    const std::size_t line = (2 * patch + (column < half ? k_lines - 1 : 0) + (is_last ? 1 : 0)) % k_lines;
    const std::size_t from_core = column < half ? half - column : column - half;
    return {storey, from_core == 0 ? 0 : line * half + from_core, line, is_last};
  };

  // The vertices of a storey: the sheet's two sides, then what rounds its rim off between them.
  const std::size_t points = 1 + k_lines * half + k_order * (rows - 1) * (columns + 1);
  std::vector<glm::dvec3> storey(2 * points + (k_rim_rows - 1) * k_lines * rows);
  const auto rim_vertex = [&](std::size_t rim, std::size_t i) {
    return 2 * points + rim * (k_rim_rows - 1) + i - 1;
  };
  for (std::size_t patch = 0; patch < k_order; ++patch) {
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 0; column <= columns; ++column) {
        const SheetPoint p = sheet_point(static_cast<double>(patch),
                                         static_cast<double>(column) / static_cast<double>(half) - 1.0,
                                         2.0 * static_cast<double>(row) / static_cast<double>(rows) - 1.0);
        const Place at = place(0, patch, row, column);
        storey[2 * at.point] = p.position - k_half_thickness * p.normal;
        storey[2 * at.point + 1] = p.position + k_half_thickness * p.normal;
        for (std::size_t i = 1; i < k_rim_rows && column % columns == 0; ++i) {
          const double angle = k_pi * static_cast<double>(i) / k_rim_rows;
          storey[rim_vertex(at.rim, i)] =
              p.position + k_half_thickness * (std::sin(angle) * p.outward - std::cos(angle) * p.normal);
        }
      }
    }
  }
  for (int i = 0; i < k_storeys; ++i)
    for (glm::dvec3 p : storey) model.vertex(turned(p, 2.0 * k_pi * i / k_storeys));

  // The faces: both sides, and the rims.
  const auto index = [&](const Place& at, std::size_t vertex) {
    return static_cast<std::uint32_t>(at.storey * storey.size() + vertex);
  };
  const auto side = [&](const Place& at, bool upper) {
    return index(at, 2 * at.point + (upper != at.is_swapped));
  };
  const auto rim = [&](const Place& at, std::size_t i) {
    if (i == 0 || i == k_rim_rows) return side(at, i > 0);
    return index(at, rim_vertex(at.rim, at.is_swapped ? k_rim_rows - i : i));
  };
  for (std::size_t n = 0; n < k_storeys * k_order * rows; ++n) {
    const std::size_t row = n % rows, patch = n / rows % k_order, at_storey = n / rows / k_order;
    const auto at = [&](std::size_t up, std::size_t column) {
      return place(at_storey, patch, row + up, column);
    };
    for (std::size_t column = 0; column < columns; ++column) {
      const Place a = at(0, column), b = at(0, column + 1), c = at(1, column + 1), d = at(1, column);
      model.quad(side(a, true), side(b, true), side(c, true), side(d, true));
      model.quad(side(a, false), side(d, false), side(c, false), side(b, false));
    }
    for (std::size_t i = 0; i < k_rim_rows; ++i) {
      const Place a = at(0, 0), b = at(1, 0), c = at(0, columns), d = at(1, columns);
      model.quad(rim(b, i), rim(a, i), rim(a, i + 1), rim(b, i + 1));
      model.quad(rim(c, i), rim(d, i), rim(d, i + 1), rim(c, i + 1));
    }
  }

  scene.cameras.push_back({"above", {1.2, 4.9, 5.4}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 48.0});
  scene.lights.push_back(point_light("lamp", {0.0, -0.8, -0.2}, glm::vec3(1.0f, 0.77f, 0.5f) * 60.0f));
  scene.medium.sigma_s = {0.11f, 0.12f, 0.13f};
  scene.medium.phase = PhaseFunction::henyey_greenstein;
  scene.medium.g = 0.2f;
  scene.exposure = 2.0f;
  return scene;
}

}  // namespace airlight::scene
