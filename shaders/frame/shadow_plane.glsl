// The shadow map of a light whose rays all cross the plane through the eye at right angles to the axis l from the eye to the
// light: a sun's, and that of a point far enough away.
//
// The map P → P / (1 − P·l / D), positions relative to the eye, takes the light at distance D to infinity and light rays to
// parallels of l. It keeps lines, planes and, since it moves points along the lines through the eye, view rays. What a light ray meets
// first is then what has the largest Z, the coordinate along l. A sun has 1/D = 0, and nothing moves.
#ifndef AIRLIGHT_SHADOW_PLANE_GLSL
#define AIRLIGHT_SHADOW_PLANE_GLSL
#include "frame/light.glsl"

// 1 − P·l / D: by how much light rays have come nearer together at a point relative to the eye.
FUNCTION float plane_share(IN(LightBlock) light, IN(vec3) point) { return 1.0f - light.inverse_distance * dot(light.axis, point); }

// Where a point of the map lies in its image, each side from −1 to 1.
FUNCTION vec2 plane_uv(IN(LightBlock) light, IN(vec3) mapped) {
  return vec2(dot(vec3(light.image_x.x, light.image_x.y, light.image_x.z), mapped) + light.image_x.w,
              dot(vec3(light.image_y.x, light.image_y.y, light.image_y.z), mapped) + light.image_y.w);
}

// Clip coordinates of a point relative to the eye. The image's rows run downwards, so its y does too.
FUNCTION vec4 plane_clip(IN(LightBlock) light, IN(vec3) point) {
  float share = plane_share(light, point);
  float x = dot(vec3(light.image_x.x, light.image_x.y, light.image_x.z), point) + light.image_x.w * share;
  float y = dot(vec3(light.image_y.x, light.image_y.y, light.image_y.z), point) + light.image_y.w * share;
  return vec4(x, -y, light.depth_scale * dot(light.axis, point) + light.depth_offset * share, share);
}

// Z of what is stored [m].
FUNCTION float plane_z(IN(LightBlock) light, float depth) { return (depth - light.depth_offset) / light.depth_scale; }

#endif
