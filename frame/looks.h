#pragma once

#include <cstdint>
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

  /// Whether a model has any.
  static bool are_in(const scene::Geometry& geometry) {
    return !geometry.textures.empty() || !geometry.normals.empty();
  }
  bool has_textures() const { return has_textures_; }
  bool has_normals() const { return has_normals_; }

  /// Of each triangle's corners, in its order: vec2, three a triangle. Empty without textures.
  const gpu::Buffer& texture_places() const { return texture_places_; }

  /// Binds textures and what materials have of them (shaders/frame/textures.glsl), where there are any.
  void bind_textures() const;

  /// The surfaces of a frame, into images that get its size. The camera's block is bound.
  /// @param scene whose looks these are @param triangles as of GBuffer
  void draw(const SceneBuffers& scene, const gpu::Texture& triangles, LookImages& images) const;

  std::int64_t bytes() const;

 private:
  gpu::Texture texels_;  ///< of all textures: shaders/frame/texture_filter.glsl
  bool has_textures_, has_normals_;
  gpu::Buffer material_textures_, texture_places_, normals_;
  gpu::TexelView material_texture_texels_, texture_place_texels_, normal_texels_;
  ScreenPass pass_;
};

}  // namespace airlight::frame
