#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "frame/screen_pass.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/texture.h"
#include "scene/scene.h"

namespace airlight::frame {

class SceneBuffers;

/// What the surfaces of a frame look like.
struct LookImages {
  /// rgba16f: base colours, linear, where the scene has textures.
  gpu::Texture base_colours;
  /// rgba16f: unit normals, world axes, where it has normals; turned to the side of the triangle that is
  /// seen.
  gpu::Texture shading_normals;
};

/// What a scene's surfaces look like where that is more than one colour a material and flat triangles:
/// textures, and shading normals.
///
/// No method sees it: shadows and airlight are those of the triangles.
class Looks {
 public:
  /// @param order which triangle of the geometry comes when (SceneBuffers::order)
  /// @throws scene::Error (driver) when a buffer or the textures would be larger than the driver allows.
  Looks(const gpu::Context& context, const scene::Geometry& geometry, std::span<const std::uint32_t> order);

  /// Of the same model in another pose, which has other normals.
  Looks(const gpu::Context& context, const scene::Geometry& posed, std::span<const std::uint32_t> order,
        const Looks& at_rest);

  /// Whether a model has any.
  static bool are_in(const scene::Geometry& geometry) {
    return !geometry.textures.empty() || !geometry.normals.empty();
  }
  bool has_textures() const { return textures_ != nullptr; }
  bool has_normals() const { return has_normals_; }

  /// Of each triangle's corners, in its order: vec2, three a triangle. There are textures.
  const gpu::Buffer& texture_places() const { return textures_->places; }

  /// Binds textures and what materials have of them (shaders/frame/textures.glsl), where there are any.
  void bind_textures() const;

  /// The surfaces of a frame, into images that get its size. The camera's block is bound.
  /// @param scene whose looks these are @param triangles as of GBuffer
  void draw(const SceneBuffers& scene, const gpu::Texture& triangles, LookImages& images) const;

  /// Without what those of the model at rest hold.
  std::int64_t bytes() const;

 private:
  /// What stays in any pose.
  struct Textures {
    gpu::Texture texels;  ///< of all textures: shaders/frame/texture_filter.glsl
    gpu::Buffer of_materials, places;
    gpu::TexelView of_material_texels, place_texels;

    Textures(const gpu::Context& context, const scene::Geometry& geometry,
             std::span<const std::uint32_t> order);
  };
  Looks(const gpu::Context& context, const scene::Geometry& geometry, std::span<const std::uint32_t> order,
        std::shared_ptr<const Textures> textures, std::shared_ptr<const ScreenPass> pass);

  std::shared_ptr<const Textures> textures_;  ///< nullptr for none
  bool owns_textures_ = true;                 ///< else the model at rest does
  bool has_normals_;
  gpu::Buffer normals_;
  gpu::TexelView normal_texels_;
  std::shared_ptr<const ScreenPass> pass_;
};

}  // namespace airlight::frame
