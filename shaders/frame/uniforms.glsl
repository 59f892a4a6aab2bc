// What a frame tells all of its passes. GLSL only.
#include "bindings.glsl"
#include "frame/camera.glsl"
#include "frame/light.glsl"
#include "frame/medium.glsl"

layout(std140, binding = k_camera_block) uniform CameraUniform { CameraBlock camera; };
layout(std140, binding = k_light_block) uniform LightUniform { LightBlock light; };
layout(std140, binding = k_medium_block) uniform MediumUniform { MediumBlock medium; };
