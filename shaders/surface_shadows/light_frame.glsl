// The coordinates of surface shadows. GLSL only; needs frame/uniforms.glsl.
#include "frame/light_rays.glsl"

// Where the light is, under a sun the eye, world space [m], rounded to float, and what the rounding left; and what positions
// relative to it are multiplied by.
struct LightFrame {
  vec3 high;
  vec3 low;
  float scale;
};

LightRays light_rays() { return LightRays(-light.from_eye, light.is_near == 0.0); }

vec3 in_light_frame(LightFrame frame, vec3 world) { return frame.scale * relative_to(frame.high, frame.low, world); }
