#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "frame/clusters.h"
#include "frame/looks.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/texture.h"
#include "scene/scene.h"

namespace airlight::frame {

/// Which triangles are drawn. Where the materials of some cut parts out of them, that is drawn by pipelines
/// of its own (shaders/frame/cut_out.glsl).
enum class Drawn {
  all,       ///< each as a whole
  whole,     ///< those without cut-outs
  cut_outs,  ///< the others; vertex attribute 2 = place in the material's texture
};

/// A scene's geometry on the GPU, in the order of its clusters. Triangle numbers of the shaders count in that
/// order.
class SceneBuffers {
 public:
  /// Relative to the distance between eye and light: a few roundings of a position in single precision.
  static constexpr double k_touch = 1e-6;

  /// @throws scene::Error (driver) when a buffer would be larger than the driver allows.
  SceneBuffers(const gpu::Context& context, const scene::Geometry& geometry);

  /// Of the same triangles elsewhere, in the same order.
  /// @param posed the geometry of `at_rest` in another pose (scene::posed)
  SceneBuffers(const gpu::Context& context, const scene::Geometry& posed, const SceneBuffers& at_rest);

  /// Binds positions, triangles, albedos and materials (shaders/bindings.glsl).
  void bind_samplers() const;

  /// Whether light passes any triangle (scene::transmits).
  bool transmits() const { return attenuation_texels_.has_value(); }

  /// Where light passes any: rgba32ui, one texel a triangle: Attenuation::of_channel, and whether it grows by
  /// incidence.
  const gpu::TexelView& attenuations() const { return *attenuation_texels_; }

  /// Draws what may lie in the pyramid. Vertex attributes: 0 = world position, 1 = first triangle of the
  /// draw.
  /// @param left_out triangle numbers, sorted
  void draw(const Pyramid& pyramid, std::span<const std::uint32_t> left_out = {},
            Drawn drawn = Drawn::all) const;

  /// The same for another region.
  /// @param may_touch whether a box, world space, may reach into it: never wrongly "no"
  void draw(const std::function<bool(const scene::Box&)>& may_touch,
            std::span<const std::uint32_t> left_out = {}, Drawn drawn = Drawn::all) const;

  /// Whether the materials of some triangles cut parts out of them.
  bool has_cut_outs() const { return clusters_.first_cut_out < triangle_count(); }

  /// Of a model that has any; else nullptr.
  const Looks* looks() const { return looks_ ? &*looks_ : nullptr; }

  /// World space.
  const scene::Box& box() const { return box_; }

  /// See frame::distance_to_geometry.
  double distance_to(glm::dvec3 point) const;

  /// The triangles on which the eye or the light lies, sorted: no farther from it than k_touch. Seen from
  /// there they are edge-on and hide nothing, but single precision cannot tell on which side of them it is.
  /// @param apex the eye or the light
  std::vector<std::uint32_t> triangles_at(glm::dvec3 apex, double eye_light_distance) const;

  /// A number that no other scene on the GPU has or had, and no other pose of it: what is made from one is
  /// kept by it.
  std::uint64_t id() const { return id_; }
  /// The same of the scene at rest: what is made from its triangles, wherever they are, is kept by it.
  std::uint64_t id_at_rest() const { return id_at_rest_; }
  /// order()[i] is which triangle of the geometry comes i-th here.
  const std::vector<std::uint32_t>& order() const { return clusters_.order; }
  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(clusters_.order.size()); }
  std::int64_t bytes() const;

 private:
  /// @param at_rest nullptr where this is
  SceneBuffers(const gpu::Context& context, const scene::Geometry& geometry, Clusters clusters,
               const SceneBuffers* at_rest);

  /// Triangles `first` to `end` − 1, of a cluster's number where they are from its first one on.
  void draw_triangles(std::uint32_t first, std::uint32_t end, Drawn drawn,
                      std::optional<std::size_t> cluster = {}) const;
  void make_vertex_arrays();

  const scene::Geometry* geometry_;
  std::uint64_t id_, id_at_rest_;
  scene::Box box_;
  Clusters clusters_;
  gpu::Buffer positions_, triangles_, albedos_, material_of_triangle_, first_triangles_;
  gpu::TexelView position_texels_, triangle_texels_, albedo_texels_, material_texels_;
  gpu::Buffer cut_out_positions_;  ///< three a triangle
  gpu::Buffer attenuations_;       ///< where light passes any triangle
  std::optional<gpu::TexelView> attenuation_texels_;
  gpu::Handle<gpu::delete_vertex_array> vertex_array_, cut_out_vertex_array_;
  std::optional<Looks> looks_;
};

}  // namespace airlight::frame
