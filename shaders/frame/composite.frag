#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/light_colour.glsl"
#include "frame/seen_colour.glsl"
#include "frame/uniforms.glsl"

layout(binding = k_triangle_unit) uniform usampler2D triangle_plus_one;
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(binding = k_visibility_unit) uniform sampler2D visibility_image;
layout(binding = k_airlight_unit) uniform sampler2D airlight_image;
layout(binding = k_light_texture_unit) uniform sampler2D light_texture;
layout(binding = k_shading_normal_unit) uniform sampler2D shading_normal_image;
layout(constant_id = 0) const uint k_light_textured = 0;
layout(constant_id = 2) const uint k_has_normals = 0;
layout(constant_id = 3) const uint k_glows = 0;  // light that reaches a surface's other side is what it lets through
layout(location = 0) out vec4 radiance;
layout(location = 1) out vec4 airlight;  // where that of several lights is summed

// Lambert surfaces lit by one light, attenuated from the light to the surface and on to the eye, plus its airlight.
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  airlight = vec4(texelFetch(airlight_image, pixel, 0).rgb, 1.0);
  radiance = airlight;
  uint seen = texelFetch(triangle_plus_one, pixel, 0).r;
  vec3 visibility = texelFetch(visibility_image, pixel, 0).rgb;
  if (seen != 0u && visibility != vec3(0.0)) {
    vec4 surface = texelFetch(surface_image, pixel, 0);
    float distance = surface.w;
    vec3 direction = view_ray(camera, vec2(pixel) + 0.5);
    vec3 point = distance * direction;
    vec3 way = to_light(light, point);
    float r = length(way);
    float cosine = dot(surface.xyz, way) / max(r, 1e-30);
    if (k_has_normals != 0u) {
      // The triangle itself says which side is lit: no light through a surface whose shading leans over.
      if (cosine > 0.0) cosine = dot(texelFetch(shading_normal_image, pixel, 0).xyz, way) / max(r, 1e-30);
    }
    vec2 seen_part = part_in_medium(medium, direction.y, distance);
    float path = max(seen_part.y - seen_part.x, 0.0) + light_path(medium, light, point);
    vec3 albedo = seen_colour(pixel, seen);
    if (k_glows != 0u) {
      if (cosine < 0.0) {
        cosine = -cosine;
        albedo = vec3(1.0);
      }
    }
    vec3 colour = k_light_textured != 0u ? light_colour(light_texture, -way) : vec3(1.0);
    colour *= cone_share(light, -way / max(r, 1e-30)) * range_share(light, r);
    // A sun's `way` is of unit length.
    radiance.rgb += visibility * max(cosine, 0.0) * albedo / k_pi * light.intensity / max(r * r, 1e-20) * colour *
                exp(-medium.sigma_t * path);
  }
}
