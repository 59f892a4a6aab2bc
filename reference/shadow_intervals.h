#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "reference/sun_ray.h"
#include "reference/triangles.h"
#include "reference/view_ray.h"

namespace airlight::reference {

/// Triangles that may cast a shadow on some view rays, laid out for one pass after another over all of them.
class Occluders {
 public:
  /// @param sun unit direction to the light where that is a sun
  /// @param model whose triangles they are; kept by reference. Without, they are whole and opaque.
  explicit Occluders(std::optional<glm::dvec3> sun = {}, const Triangles* model = nullptr)
      : sun_(sun),
        model_(model && !(model->cut_outs.empty() && model->attenuations.empty()) ? model : nullptr) {}

  void clear();

  /// @param corners relative to the light [m], or to the eye under a sun. A triangle edge-on to the light
  /// casts no shadow, and is left out.
  /// @param triangle its number in the model
  void add(const Corners& corners, std::uint32_t triangle = 0);

  std::size_t count() const { return corners_.size(); }
  const Corners& corners(std::size_t i) const { return corners_[i]; }

  /// What is cut out of one, or nullptr; the number by which it is asked.
  const CutOuts* cut_outs(std::size_t i) const {
    return model_ && model_->cut_outs.has(triangles_[i]) ? &model_->cut_outs : nullptr;
  }
  /// What one takes of light that passes it, or nullptr where none does.
  const glm::uvec3* attenuation(std::size_t i) const {
    return model_ && model_->transmits(triangles_[i]) ? &model_->attenuations[triangles_[i]].of_channel
                                                      : nullptr;
  }
  std::uint32_t triangle(std::size_t i) const { return triangles_[i]; }

  /// Writes the numbers of those that may cross the plane through the origin of unit normal `n`: all that do,
  /// and few that do not.
  void find_crossing(const glm::dvec3& n, std::vector<std::uint32_t>& crossing);

 private:
  std::optional<glm::dvec3> sun_;
  const Triangles* model_;  ///< where it says more than corners
  std::vector<Corners> corners_;
  std::vector<std::uint32_t> triangles_;   ///< where there is a model
  std::vector<float> x_[3], y_[3], z_[3];  ///< corners in single precision
  std::vector<float> margin_;              ///< how far their distance from a plane may be off [m]
  std::vector<std::int32_t> flags_;
};

/// The part of one view ray that is in shadow, without any sampling. Keeps its memory from ray to ray.
///
/// The half-plane of light and view ray cuts a triangle in a segment. Seen from the light, the segment hides
/// one interval of the ray; the union of the intervals of all triangles is the shadow. With x along the ray
/// and y across, from the light, the ray is the line y = h, and a point (x, y) with 0 < y < h casts its
/// shadow to the ray's point x h/y. Intervals are kept in u = x/y = cot ψ (view_ray.h): no trigonometry is
/// needed to find them. A sun's shadows are cast along its direction, and kept in u = t (sun_ray.h).
///
/// What makes shadows tight: a corner is on one side of the half-plane or on the other, never on it (zero
/// counts as positive), and an edge's point in the half-plane is computed in the same order of its ends by
/// both of its triangles. Neighbouring triangles thus hide intervals that touch bit by bit, and a closed
/// surface lets no light through where a ray's half-plane meets its edges, corners, or a whole face.
/// Of a triangle that is cut out, each part of the segment where there is a surface hides an interval. One
/// that light passes hides nothing, but takes its part of the light there.
class ShadowIntervals {
 public:
  /// Finds what is lit of the view ray.
  /// @param occluders all that can cast a shadow on it
  void trace(const ViewRay& ray, Occluders& occluders);
  void trace(const SunRay& ray, Occluders& occluders);

  /// A lit interval of the ray, in its order: of falling ψ [rad] of a `ViewRay`, of growing t [m] of a
  /// `SunRay`.
  struct Run {
    double from, to;
    glm::dvec3 share{1.0};  ///< of the light, RGB: what triangles let through on which it falls before
  };
  const std::vector<Run>& lit_runs() const { return lit_; }

  /// Triangles that hide a part of the ray, or let a share of the light through to it.
  std::size_t count() const { return intervals_.size() + tinted_.size(); }

 private:
  struct Interval {
    double from, to;  ///< u
  };
  template <class Ray>
  void find_shadows(const Ray& ray, const Interval& range, Occluders& occluders);
  template <class Ray>
  void add_shadow(const Ray& ray, const Interval& range, const Occluders& occluders, std::size_t i);
  template <class Function>
  void for_each_gap(const Interval& range, const Function& f) const;
  template <class Function>
  void for_each_lit(const Interval& range, const Function& f);

  std::vector<std::uint32_t> crossing_;
  std::vector<CutOuts::Part> parts_;
  std::vector<Interval> intervals_;
  /// In the shadow of a triangle that light passes.
  struct Tinted {
    Interval interval;
    glm::uvec3 attenuation;
  };
  std::vector<Tinted> tinted_;
  /// Where such a shadow begins, or ends.
  struct Change {
    double at;                              ///< u
    glm::vec<3, std::int64_t> attenuation;  ///< that is added
  };
  std::vector<Change> changes_;
  std::vector<Run> lit_;
};

}  // namespace airlight::reference
