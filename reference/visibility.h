#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "reference/reference.h"
#include "reference/triangles.h"
#include "scene/scene.h"

namespace airlight::reference {

/// Light rays that are traced together: neighbours along one view ray, so that they form a fan.
struct LightRays {
  static constexpr int k_count = 16;
  alignas(64) float direction_x[k_count];  ///< unit direction away from the light
  alignas(64) float direction_y[k_count];
  alignas(64) float direction_z[k_count];
  alignas(64) float length[k_count];  ///< from the light to the sample [m]
};

/// Rays to a sun that are traced together: parallel, from neighbours along one view ray.
struct SunwardRays {
  static constexpr int k_count = LightRays::k_count;
  alignas(64) float origin_x[k_count];  ///< relative to the eye [m]
  alignas(64) float origin_y[k_count];
  alignas(64) float origin_z[k_count];
};

/// Which points the light sees: rays cast by Embree through triangles held relative to the light, or to the
/// eye under a sun.
///
/// Light rays start at the light, so that all the rays of a view ray share their origin and descend the
/// hierarchy together. Those of a sun start at the points. A triangle that holds the light casts no shadow,
/// and one that holds the eye is not seen (triangles.h). Embree's robust mode lets no ray through the edge
/// between two triangles.
class Visibility {
 public:
  /// @param triangles kept by reference
  /// @param origin, eye world space [m]; the origin is where a point light is, and under a sun the eye
  /// @param sun         unit direction to the light where that is a sun
  /// @throws scene::Error (driver) when Embree fails
  Visibility(const Triangles& triangles, const glm::dvec3& origin, const glm::dvec3& eye,
             const std::optional<glm::dvec3>& sun = {});
  ~Visibility();
  Visibility(Visibility&&) noexcept;
  Visibility& operator=(Visibility&&) noexcept;

  struct Hit {
    double distance;         ///< from the eye [m]; 0 for none
    std::uint32_t triangle;  ///< its number
  };
  /// The first surface along the view ray of that unit direction.
  Hit first_hit(const glm::dvec3& direction) const;

  /// Whether the side that is seen of a surface is lit at a first hit: it faces the light, whichever way the
  /// triangle's corners go round, and nothing lies between.
  ///
  /// A triangle in whose
  /// plane the point lies (to 1e-6 of the distances involved) casts no shadow on it, which rids the surface,
  /// its coplanar neighbours, and surfaces seen edge-on by the light of shadows on themselves without any
  /// offset along the ray.
  /// @param direction that `first_hit` was asked for
  /// @param towards the light, from that point: of unit length
  bool surface_lit(const Hit& hit, const glm::dvec3& direction, const glm::dvec3& towards) const;

  /// Bit i is set where ray i of the first `count` reaches its sample.
  std::uint32_t lit(const LightRays& rays, int count, RayMode mode) const;
  std::uint32_t lit(const SunwardRays& rays, int count, RayMode mode) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace airlight::reference
