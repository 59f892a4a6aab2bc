#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "frame/shadow_cube.glsl"
#include "frame/shadow_plane.glsl"

layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(binding = k_shadow_map_unit) uniform sampler2DArray shadow_map;
layout(location = 0) out float visibility;

layout(constant_id = 0) const bool k_plane = false;

// Relative slack of the depth test on a plane: what single precision leaves.
const float k_slack = 1e-4;
// A curved surface may lie on a neighbouring facet at the texel's centre, which differs from the plane by a share of what the plane
// rises over a texel. In texels; a whole one detaches more shadows from their casters than it mends.
//
// It is also what rasterisation may take: it snaps corners to 2^−GL_SUBPIXEL_BITS texel, at worst to 1/16 (at least 4 bits;
// GPUs have 8), and a point of a triangle moves by no more than its corners, half a step along each side of the texel: √2/32 =
// 0.044 texels. With `rise` below cut at 20 that holds to half a degree of edge-on, where Lambert's cosine leaves 1 % of the light.
const float k_bend = 0.25;
// What single precision leaves of Z on a plane, of the range that the map holds.
const float k_plane_slack = 1e-5;
// Cosine below which a surface rises no faster than this over a texel: half a degree of edge-on.
const float k_least_facing = 0.01;
// Of lengths: how far a plane may miss the light and still hold it.
const float k_edge_on = 1e-6;

// How far a plane rises over a texel, of the texel's width, by the cosine between its normal and the light ray.
float rise_at(float cosine) { return sqrt(max(1.0 - cosine * cosine, 0.0)) / max(abs(cosine), 0.05); }

// Of a map on a plane, whether the light reaches a point of the surface `normal` · P = `offset`, which faces it.
bool is_lit_on_plane(vec3 point, vec3 normal, float offset) {
  vec3 p = point / plane_share(light, point);
  vec3 n = normalize(normal - offset * light.inverse_distance * light.axis);  // of the surface on the map
  vec2 uv = plane_uv(light, p);
  ivec2 texel = cube_texel(uv, light.shadow_map_size);
  float depth = texelFetch(shadow_map, ivec3(texel, 0), 0).r;
  // To where the texel's centre looks. The image's axes are at right angles, and as long as what they scale by.
  vec2 by = cube_texel_centre(texel, light.shadow_map_size) - uv;
  vec3 across = by.x * light.image_x.xyz / dot(light.image_x.xyz, light.image_x.xyz) +
                by.y * light.image_y.xyz / dot(light.image_y.xyz, light.image_y.xyz);
  float cosine = dot(n, light.axis);
  float receiver = dot(light.axis, p) - dot(n, across) / max(cosine, k_least_facing);
  float slack = k_plane_slack / light.depth_scale + k_bend * rise_at(cosine) * 2.0 * light.half_texel;
  return depth == 0.0 || plane_z(light, depth) <= receiver + slack;
}

// Shadow-map look-up with the receiver's own plane as bias: the surface is compared where the texel's centre looks, not where
// the pixel does, so that slope causes no acne and needs no offset.
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 surface = texelFetch(surface_image, pixel, 0);
  visibility = 0.0;
  if (surface.w > 0.0) {
    vec3 seen = surface.w * view_ray(camera, vec2(pixel) + 0.5);
    if (k_plane) {
      float offset = dot(surface.xyz, seen);
      vec3 way = to_light(light, seen);
      bool faces = dot(surface.xyz, way) >= -k_edge_on * length(way);
      visibility = faces && is_lit_on_plane(seen, surface.xyz, offset) ? 1.0 : 0.0;
      return;
    }
    vec3 from_light = seen - light.from_eye;
    CubePoint point = cube_point(from_light);
    ivec2 texel = cube_texel(point.uv, light.shadow_map_size);
    float depth = texelFetch(shadow_map, ivec3(texel, point.face), 0).r;
    vec3 centre = cube_direction(point.face, cube_texel_centre(texel, light.shadow_map_size));
    float plane = dot(surface.xyz, from_light);
    float slope = dot(surface.xyz, centre);
    // The depth of the plane at the texel's centre is plane / slope. A surface seen edge-on from the light has none there: its
    // own has to do.
    float far_plane = slope < 0.0 ? -plane : plane;
    bool has_depth = far_plane > 0.5 * point.depth * abs(slope) && far_plane < 2.0 * point.depth * abs(slope);
    float receiver = has_depth ? far_plane / abs(slope) : point.depth;
    float rise = rise_at(dot(surface.xyz, normalize(centre)));  // by depth and texel width
    float slack = k_slack + k_bend * rise * 2.0 / light.shadow_map_size;
    // A surface that turns its back to the light is dark; one seen edge-on faces it as far as single precision can tell.
    bool faces_light = plane <= k_edge_on * (surface.w + length(from_light));
    visibility = faces_light && (depth == 0.0 || receiver * depth <= light.near * (1.0 + slack)) ? 1.0 : 0.0;
  }
}
