#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace airlight::scene {

/// The names of `Transmission`'s values that users know them by, in their order.
std::span<const std::string_view> transmission_names();

/// What one triangle takes of the light that passes straight through it, a channel each, as −log₂ of the
/// share that it lets through, in parts of k_halving. Whole numbers add up to the same in whatever order
/// triangles are met.
/// Laid out as shaders read it.
struct Attenuation {
  static constexpr std::uint32_t k_halving = 1u << 16;
  /// Of so much and more nothing is left.
  static constexpr std::uint32_t k_nothing_left = 40 * k_halving;

  glm::uvec3 of_channel{k_nothing_left};
  /// Whether that is what light takes that falls on it at right angles, and other light as much more as its
  /// way through a layer is longer, divided by the cosine: 1 or 0.
  std::uint32_t grows_by_incidence = 0;

  bool is_opaque() const { return of_channel == glm::uvec3(k_nothing_left); }
  bool operator==(const Attenuation&) const = default;
};
static_assert(sizeof(Attenuation) == sizeof(glm::uvec4));

/// Of light that falls on a triangle under an angle of that cosine, in [0, 1].
glm::uvec3 attenuation_at(const Attenuation& attenuation, double cosine);

/// Adds what another triangle takes: never above Attenuation::k_nothing_left.
glm::uvec3 add_attenuation(glm::uvec3 sum, glm::uvec3 other);

/// What a sum of attenuations leaves of the light, in [0, 1].
glm::dvec3 share_left(glm::uvec3 sum);

/// Whether light passes any triangle.
bool transmits(const Geometry& geometry);

/// Whether that depends on the angle under which it falls on triangles.
bool transmits_by_incidence(const Geometry& geometry);

/// Of one triangle, as the geometry's materials and its `transmission` say.
///
/// `x_ray` and `x_ray_coloured` after Gerhards, Mora, Aveneau, Ghazanfarpour, "Partitioned Shadow Volumes",
/// Eurographics 2015, section 4.3, which does not say how much each triangle takes.
Attenuation attenuation_of(const Geometry& geometry, std::uint32_t triangle);

/// Of each triangle; empty where light passes none.
std::vector<Attenuation> attenuations_of(const Geometry& geometry);

}  // namespace airlight::scene
