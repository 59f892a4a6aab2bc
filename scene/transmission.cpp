#include "scene/transmission.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace airlight::scene {
namespace {

/// Of light at right angles, a triangle of an x-ray view takes this part of a halving: a closed body of two
/// walls lets seven tenths through in its middle.
constexpr double k_x_ray = 0.25;
/// Of the colours that a coloured one takes most.
constexpr double k_x_ray_coloured = 1.0;

std::uint32_t attenuation(double halvings) {
  const double parts = halvings * Attenuation::k_halving;
  return parts < Attenuation::k_nothing_left ? static_cast<std::uint32_t>(std::lround(parts))
                                             : Attenuation::k_nothing_left;
}

/// A pure colour that neighbours in a list do not share: hues a golden section of the circle apart.
glm::dvec3 colour_of(std::uint32_t number) {
  const double turns = std::fmod(0.618033988749895 * number, 1.0);
  glm::dvec3 colour;
  for (int channel = 0; channel < 3; ++channel) {
    const double way =
        std::abs(std::fmod(turns + 1.0 - channel / 3.0, 1.0) - 0.5);  // 1/2: the channel's own hue
    colour[channel] = std::clamp(6.0 * way - 1.0, 0.0, 1.0);
  }
  return colour;
}

}  // namespace

std::span<const std::string_view> transmission_names() {
  static constexpr std::array<std::string_view, 4> k_names = {"material", "opaque", "x-ray",
                                                              "x-ray-coloured"};
  return k_names;
}

glm::uvec3 attenuation_at(const Attenuation& attenuation, double cosine) {
  if (!attenuation.grows_by_incidence) return attenuation.of_channel;
  glm::uvec3 grown;
  for (int channel = 0; channel < 3; ++channel)
    grown[channel] = scene::attenuation(static_cast<double>(attenuation.of_channel[channel]) /
                                        Attenuation::k_halving / std::max(cosine, 1e-9));
  return grown;
}

glm::uvec3 add_attenuation(glm::uvec3 sum, glm::uvec3 other) {
  return glm::min(sum + other, glm::uvec3(Attenuation::k_nothing_left));
}

glm::dvec3 share_left(glm::uvec3 sum) {
  glm::dvec3 share(0.0);
  for (int channel = 0; channel < 3; ++channel)
    if (sum[channel] < Attenuation::k_nothing_left)
      share[channel] = std::exp2(-static_cast<double>(sum[channel]) / Attenuation::k_halving);
  return share;
}

bool transmits(const Geometry& geometry) {
  if (geometry.triangles.empty() || geometry.transmission == Transmission::opaque) return false;
  if (geometry.transmission != Transmission::material) return true;
  return std::any_of(geometry.materials.begin(), geometry.materials.end(),
                     [](const Material& material) { return material.transmittance != glm::vec3(0.0f); });
}

bool transmits_by_incidence(const Geometry& geometry) {
  return geometry.transmission == Transmission::x_ray ||
         geometry.transmission == Transmission::x_ray_coloured;
}

Attenuation attenuation_of(const Geometry& geometry, std::uint32_t triangle) {
  switch (geometry.transmission) {
    case Transmission::opaque:
      return {};
    case Transmission::material: {
      const glm::dvec3 share(geometry.materials[geometry.material_of_triangle[triangle]].transmittance);
      return {{attenuation(-std::log2(share.r)), attenuation(-std::log2(share.g)),
               attenuation(-std::log2(share.b))}};
    }
    case Transmission::x_ray:
      return {glm::uvec3(attenuation(k_x_ray)), true};
    case Transmission::x_ray_coloured: {
      const glm::dvec3 taken = k_x_ray + (k_x_ray_coloured - k_x_ray) * (1.0 - colour_of(triangle));
      return {{attenuation(taken.r), attenuation(taken.g), attenuation(taken.b)}, true};
    }
  }
  return {};
}

std::vector<Attenuation> attenuations_of(const Geometry& geometry) {
  std::vector<Attenuation> attenuations;
  if (!transmits(geometry)) return attenuations;
  attenuations.reserve(geometry.triangles.size());
  for (std::uint32_t i = 0; i < geometry.triangles.size(); ++i)
    attenuations.push_back(attenuation_of(geometry, i));
  return attenuations;
}

}  // namespace airlight::scene
