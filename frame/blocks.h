#pragma once

#include "frame/scene_buffers.h"
#include "scene/scene.h"
#include "shared.h"

namespace airlight::shaders {
#include "bindings.glsl"
#include "frame/camera.glsl"
#include "frame/light.glsl"
#include "frame/light_texture.glsl"
#include "frame/medium.glsl"
#include "frame/shadow_cube.glsl"
static_assert(sizeof(CameraBlock) == 80 && sizeof(LightBlock) == 32 && sizeof(MediumBlock) == 32,
              "must match std140");
}  // namespace airlight::shaders

namespace airlight::frame {

// The uniform blocks of a frame.

/// @param light_distance from the eye to the nearest light [m]
shaders::CameraBlock camera_block(const SceneBuffers& scene, const scene::CameraFrame& camera,
                                  glm::ivec2 image_size, double light_distance);

/// @param shadow_map_size side of a cube face [texels]
shaders::LightBlock light_block(const SceneBuffers& scene, const scene::Light& light, glm::dvec3 eye,
                                int shadow_map_size);

shaders::MediumBlock medium_block(const scene::Medium& medium);

}  // namespace airlight::frame
