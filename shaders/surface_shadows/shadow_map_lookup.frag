#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/uniforms.glsl"
#include "frame/shadow_cube.glsl"

layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(binding = k_shadow_map_unit) uniform sampler2DArray shadow_map;
layout(location = 0) out float visibility;

// Relative slack of the depth test on a plane: what single precision leaves.
const float k_slack = 1e-4;
// A curved surface may lie on a neighbouring facet at the texel's centre, which differs from the plane by a share of what the plane
// rises over a texel. In texels; a whole one detaches more shadows from their casters than it mends.
//
// It is also what rasterisation may take: it snaps corners to 2^−GL_SUBPIXEL_BITS texel, at worst to 1/16 (at least 4 bits;
// GPUs have 8), and a point of a triangle moves by no more than its corners, half a step along each side of the texel: √2/32 =
// 0.044 texels. With `rise` below cut at 20 that holds to half a degree of edge-on, where Lambert's cosine leaves 1 % of the light.
const float k_bend = 0.25;
// Of lengths: how far a plane may miss the light and still hold it.
const float k_edge_on = 1e-6;

// Shadow-map look-up with the receiver's own plane as bias: the surface is compared where the texel's centre looks, not where
// the pixel does, so that slope causes no acne and needs no offset.
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 surface = texelFetch(surface_image, pixel, 0);
  visibility = 0.0;
  if (surface.w > 0.0) {
    vec3 from_light = surface.w * view_ray(camera, vec2(pixel) + 0.5) - light.from_eye;
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
    float cosine = abs(dot(surface.xyz, normalize(centre)));
    float rise = sqrt(max(1.0 - cosine * cosine, 0.0)) / max(cosine, 0.05);  // of the plane, by depth and texel width
    float slack = k_slack + k_bend * rise * 2.0 / light.shadow_map_size;
    // A surface that turns its back to the light is dark; one seen edge-on faces it as far as single precision can tell.
    bool faces_light = plane <= k_edge_on * (surface.w + length(from_light));
    visibility = faces_light && (depth == 0.0 || receiver * depth <= light.near * (1.0 + slack)) ? 1.0 : 0.0;
  }
}
