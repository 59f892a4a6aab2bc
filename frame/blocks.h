#pragma once

#include <optional>

#include "frame/scene_buffers.h"
#include "frame/shadow_plane.h"
#include "scene/scene.h"
#include "shared.h"

namespace airlight::shaders {
#include "bindings.glsl"
#include "frame/camera.glsl"
#include "frame/light.glsl"
#include "frame/light_texture.glsl"
#include "frame/medium.glsl"
#include "frame/ray_list_block.glsl"
#include "frame/shadow_cube.glsl"
#include "frame/shadow_plane.glsl"
static_assert(sizeof(CameraBlock) == 80 && sizeof(LightBlock) == 128 && sizeof(MediumBlock) == 48 &&
                  sizeof(RayListBlock) == 32,
              "must match std140");
}  // namespace airlight::shaders

namespace airlight::frame {

/// The depth [m] at which a pyramid at `apex`, the eye or the light, starts to order surfaces: nothing that
/// is drawn in it is nearer. As large as the scene allows, because depth is interpolated on triangles that
/// reach up to it; what is nearer than SceneBuffers::k_touch of the distance between eye and light is not
/// drawn.
/// @param half_width, half_height of the pyramid at depth 1; of a cube face 1
float near_depth(const SceneBuffers& scene, glm::dvec3 apex, double eye_light_distance,
                 double half_width = 1.0, double half_height = 1.0);

// The uniform blocks of a frame.

/// @param near see CameraBlock
shaders::CameraBlock camera_block(const scene::CameraFrame& camera, glm::ivec2 image_size, float near);

/// Of a light whose shadow map is a cube, if `plane` is none.
/// @param near see LightBlock
/// @param shadow_map_size side of the map, or of a face of the cube [texels]
shaders::LightBlock light_block(const scene::Light& light, glm::dvec3 eye, float near, int shadow_map_size,
                                const std::optional<ShadowPlane>& plane = {});

/// @param eye world space [m]
shaders::MediumBlock medium_block(const scene::Medium& medium, glm::dvec3 eye);

}  // namespace airlight::frame
