#pragma once

#include <cstdint>
#include <span>

#include "frame/scene_buffers.h"
#include "frame/screen_pass.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/texture.h"
#include "scene/scene.h"

namespace airlight::frame {

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

  /// The surfaces of a frame, into the images below. The camera's block is bound.
  /// @param triangles as of GBuffer
  void draw(const SceneBuffers& scene, const gpu::Texture& triangles);

  /// rgba16f: base colours, linear, where the scene has textures.
  const gpu::Texture& base_colours() const { return base_colours_; }
  /// rgba16f: unit normals, world axes, where it has normals; turned to the side of the triangle that is
  /// seen.
  const gpu::Texture& shading_normals() const { return shading_normals_; }

  /// Frees the images.
  void free_images();

 private:
  gpu::Texture texels_;  ///< of all textures: shaders/frame/texture_filter.glsl
  bool has_textures_, has_normals_;
  gpu::Buffer material_textures_, texture_places_, normals_;
  gpu::TexelView material_texture_texels_, texture_place_texels_, normal_texels_;
  ScreenPass pass_;
  gpu::Texture base_colours_, shading_normals_;
};

}  // namespace airlight::frame
