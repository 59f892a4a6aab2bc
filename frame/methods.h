#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/texture.h"
#include "gpu/timer.h"
#include "scene/scene.h"

namespace airlight::frame {

class SceneBuffers;
class ShadowMap;

/// What the methods of a frame read. The view's uniform block is bound at uniform binding 0
/// (shaders/frame/view.glsl).
struct FrameInputs {
  gpu::Context& context;
  const scene::View& view;
  const SceneBuffers& scene;
  const gpu::Texture& triangles;  ///< r32ui: number of the triangle seen + 1, 0 for none
  const gpu::Texture&
      surfaces;  ///< rgba32f: unit normal towards the eye, distance along the unit view ray [m]; 0 for none
  const ShadowMap* shadow_map;  ///< nullptr unless a method needs it
  const gpu::Texture*
      light_texture;  ///< rgba32f, by direction (light_texture.glsl); nullptr where the light has none
  gpu::StageTimer& timer;
};

/// A method of surface shadow: one of the two places where a method plugs into the frame.
class SurfaceShadow {
 public:
  virtual ~SurfaceShadow() = default;
  virtual bool needs_shadow_map() const { return false; }

  /// Writes 1 where a surface sees the light, 0 where it does not. Times its stages, `surface_query` among
  /// them.
  /// @param visibility r32f, of the image's size; what it holds where no surface is seen does not matter
  virtual void query(const FrameInputs& inputs, const gpu::Texture& visibility) = 0;

  /// Memory of its own on the GPU, by name.
  virtual std::map<std::string, std::int64_t> bytes() const { return {}; }
};

/// A picture of what a method holds.
struct DebugImage {
  std::string name;     ///< fit for a file name
  std::string caption;  ///< what is shown, in one line
  glm::ivec2 size{0};
  std::vector<float> values;  ///< fractions of 1, row 0 at the top
};

/// A method of airlight: the other place.
class Airlight {
 public:
  virtual ~Airlight() = default;
  virtual bool needs_shadow_map() const { return false; }

  /// Writes the light scattered once towards the eye along each view ray, RGB [W/(m² sr)]. Times its stages.
  /// @param radiance rgba32f, of the image's size
  virtual void integrate(const FrameInputs& inputs, const gpu::Texture& radiance) = 0;

  /// Memory of its own on the GPU, by name.
  virtual std::map<std::string, std::int64_t> bytes() const { return {}; }

  /// Pictures of what `integrate`, called just before with the same inputs, left on the GPU. They may cost
  /// it: the next call is to `integrate`.
  virtual std::vector<DebugImage> debug_images(const FrameInputs&) { return {}; }
};

/// `none`: every surface is lit.
class NoShadow : public SurfaceShadow {
 public:
  void query(const FrameInputs& inputs, const gpu::Texture& visibility) override;
};

/// `none`: no airlight.
class NoAirlight : public Airlight {
 public:
  void integrate(const FrameInputs& inputs, const gpu::Texture& radiance) override;
};

}  // namespace airlight::frame
