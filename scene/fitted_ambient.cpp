#include "scene/fitted_ambient.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "scene/srgb.h"

namespace airlight::scene {
namespace {

/// Linear.
glm::dvec3 mean_colour(const TextureImage& texture) {
  const std::array<double, 256>& linear = linear_of_bytes();
  glm::dvec3 sum(0.0);
  for (const glm::u8vec4& texel : texture.texels)
    sum += glm::dvec3(linear[texel.r], linear[texel.g], linear[texel.b]);
  return sum / static_cast<double>(texture.texels.size());
}

/// Of the surfaces, by their area.
glm::dvec3 mean_colour(const Geometry& geometry) {
  std::vector<glm::dvec3> colours;
  for (const Material& material : geometry.materials) {
    colours.emplace_back(material.albedo);
    if (material.texture) colours.back() *= mean_colour(geometry.textures[*material.texture]);
  }
  glm::dvec3 sum(0.0);
  double area = 0.0;
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    const glm::uvec3 t = geometry.triangles[i];
    const glm::dvec3 a = geometry.positions[t.x], b = geometry.positions[t.y], c = geometry.positions[t.z];
    const double own = glm::length(glm::cross(b - a, c - a));
    sum += own * colours[geometry.material_of_triangle[i]];
    area += own;
  }
  return sum / area;
}

}  // namespace

glm::vec3 fitted_ambient(const Geometry& geometry, std::span<const Light> lights, const Medium& medium) {
  const Box box = bounds(geometry);
  if (box.empty()) return glm::vec3(0.0f);
  const glm::dvec3 size = glm::dvec3(box.upper) - glm::dvec3(box.lower);
  const glm::dvec3 sides(size.y * size.z, size.z * size.x, size.x * size.y);
  glm::dvec3 flux(0.0);  // [W]
  for (const Light& light : lights) {
    if (is_sun(light)) {
      flux += glm::dvec3(light.irradiance) * glm::dot(glm::abs(light.towards), sides);
      continue;
    }
    // Of a spot all of its cone counts, its soft edge as well.
    const double solid_angle =
        2.0 * std::numbers::pi * (light.cone ? 1.0 - std::cos(light.cone->outer) : 2.0);
    flux += glm::dvec3(light.intensity) * solid_angle;
  }
  const double area = 2.0 * (sides.x + sides.y + sides.z);
  const glm::dvec3 left = glm::exp(-0.5 * glm::length(size) * glm::dvec3(medium.sigma_a));
  return mean_colour(geometry) * flux * left / (std::numbers::pi * area);
}

}  // namespace airlight::scene
