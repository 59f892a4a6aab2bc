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

/// The depth [m] at which a pyramid at `apex`, the eye or the light, starts to order surfaces. As large as
/// the scene allows, because depth is interpolated on triangles that reach up to it; not smaller than half of
/// SceneBuffers::k_touch of the distance between eye and light, since nothing nearer is drawn.
float near_depth(const SceneBuffers& scene, glm::dvec3 apex, double eye_light_distance);

// The uniform blocks of a frame.

/// @param near see CameraBlock
shaders::CameraBlock camera_block(const scene::CameraFrame& camera, glm::ivec2 image_size, float near);

/// @param near see LightBlock
/// @param shadow_map_size side of a cube face [texels]
shaders::LightBlock light_block(const scene::Light& light, glm::dvec3 eye, float near, int shadow_map_size);

shaders::MediumBlock medium_block(const scene::Medium& medium);

}  // namespace airlight::frame
