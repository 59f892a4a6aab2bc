#pragma once

#include "frame/scene_buffers.h"
#include "gpu/pipeline.h"
#include "gpu/texture.h"

/// What the methods that show what light passes have alike: see shaders/surface_shadows/transmission.glsl.
namespace airlight::surface_shadows {

/// Of an image of what arrives of the light, of a method that shows what light passes.
inline gpu::Format transmission_format(const frame::SceneBuffers& scene) {
  return scene.transmits() ? gpu::Format::rgba32f : gpu::Format::r32f;
}

/// k_transmits of shaders/surface_shadows/transmission.glsl.
inline gpu::Constant transmission_constant(const frame::SceneBuffers& scene) {
  return gpu::Constant(34, scene.transmits() ? 1u : 0u);
}

}  // namespace airlight::surface_shadows
