#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include <glm/glm.hpp>

#include "reference/view_ray.h"
#include "scene/scene.h"

namespace airlight::reference {

/// What the cone and the range of a lamp leave of its light along one view ray (scene.h: Cone, Light::range).
/// The ray is cut where it crosses the outer and the inner cone and the sphere of the range.
class LightShape {
 public:
  explicit LightShape(const scene::Light& light);

  /// Whether the light has any: a lamp without a cone and a range does not.
  bool is_shaped() const { return cone_ || range_; }

  void aim(const ViewRay& ray);

  /// From 0 to 1, at the angle ψ (view_ray.h).
  double at(double psi) const;

  /// The longest interval from ψ on, within a piece, over which the range's share is smooth: where the ray
  /// passes close by the light, r changes as fast as π − ψ does.
  double smooth_length(double psi) const;

  /// Calls f(from, to, is_even) with each piece of [`psi_to`, `psi_from`] that has light, in falling order of
  /// ψ, and whether all of it is 1 there.
  template <class Function>
  void for_each_piece(double psi_from, double psi_to, const Function& f) const {
    for (const Piece& piece : pieces_) {
      const double from = std::min(psi_from, piece.from), to = std::max(psi_to, piece.to);
      if (to < from) f(from, to, piece.is_even);
    }
  }

 private:
  /// Of ψ, falling; empty where from ≤ to.
  struct Piece {
    double from = 0.0, to = 0.0;
    bool is_even = false;
  };

  std::optional<scene::Cone> cone_;
  std::optional<double> range_;
  double fall_inner_ = 0.0, fall_outer_ = 0.0;  ///< of the half-angles γ: 1 − cos γ

  // Of the view ray:
  double nearest_ = 0.0;     ///< ψ of the light ray nearest to the axis
  double in_plane_ = 0.0;    ///< length of the axis's part in the half-plane's plane
  double least_fall_ = 0.0;  ///< 1 − in_plane_
  double relative_ = 0.0;    ///< D sin α / range
  std::array<Piece, 3> pieces_{};
};

}  // namespace airlight::reference
