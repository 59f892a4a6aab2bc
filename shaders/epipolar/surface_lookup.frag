#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/uniforms.glsl"
#include "frame/shadow_cube.glsl"
#include "epipolar/resolution.glsl"
#include "epipolar/phi_range.glsl"
#include "epipolar/planes.glsl"

// Is a pixel's surface lit? One bit of the shadow volume tells: that of the last voxel in front of the surface, on the light ray
// that is nearest to the surface's point.
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(binding = k_grid_unit) uniform usamplerBuffer grid_texels;
layout(location = 0) out float visibility;

// Whether a voxel is dark as soon as a triangle touches it, or only where its centre is in shadow.
layout(constant_id = 3) const bool k_whole_voxels = false;

// How far a light ray may pass from the texel of the shadow map that answered for it [texels]: half a texel's diagonal, and a
// quarter more for a surface that bends between the two (surface_shadows/shadow_map_lookup.frag).
const float k_texel_reach = 0.96;
// Of a cell of α: what single precision leaves of a plane that a light ray grazes.
const float k_rounding = 0.02;
// Of lengths: what voxelization adds to a triangle for single precision and for the curvature of a slab (conservative.glsl).
const float k_length_slack = 1e-4;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 surface = texelFetch(surface_image, pixel, 0);
  vec3 direction = view_ray(camera, vec2(pixel) + 0.5);
  EyeAngle angle = eye_angle(space, direction, quarter_pixel(camera));

  // The light ray whose cell holds the surface's point.
  PhiCells cells = phi_cells();
  float k = clamp(floor(cell_of_phi(cells, phi_at(space, angle, surface.w))), 0.0, float(k_phi_count) - 1.0);
  uint j = theta_cell(space, theta_of(space, direction), k_theta_count);
  float phi = phi_of_cell(cells, k + (k_whole_voxels ? 1.0 : 0.5));
  float sin_phi = sine(phi);
  float cos_phi = cosine(phi);
  vec2 plane_direction = texelFetch(planes, int(j)).xy;
  vec3 outward = plane_direction.x * space.u + plane_direction.y * space.f;
  vec3 ray = sin_phi * outward - cos_phi * space.axis;

  // Where it, or a ray that the grid may have taken for it, first meets the surface's plane: there the surface's own shadow begins.
  // Seen from eye and light on its lit side, a plane has the smaller α the larger φ is.
  float plane = surface.w * dot(surface.xyz, direction) - dot(surface.xyz, light.from_eye);  // its distance from the light, < 0
  float slope = dot(surface.xyz, ray);
  CubePoint towards_cube = cube_point(ray);
  float along_face = surface[towards_cube.face >> 1];
  float spread = k_whole_voxels ? 0.5 * space.theta_step / (1.0 - space.theta_growth) * sin_phi * abs(dot(surface.xyz, cross(space.axis, outward)))
                                : k_texel_reach * 2.0 / light.shadow_map_size * towards_cube.depth *
                                      sqrt(max(1.0 - along_face * along_face, 0.0));
  float near = plane + (k_whole_voxels ? k_length_slack * max(surface.w, space.distance) : 0.0);
  float r = min(near, 0.0) / min(slope - spread, -1e-20);
  float own = (alpha_at(space, sin_phi, cos_phi, r) - space.alpha_min) / space.alpha_step - k_rounding;
  float before = k_whole_voxels ? floor(own) - 1.0 : ceil(own - 0.5) - 1.0;
  float i = min(before, float(alpha_cell(space, alpha_of(angle), k_alpha_count)));

  bool is_lit = plane < 0.0;  // a surface that faces away is dark
  if (i >= 0.0) {
    uint bit = uint(k);
    uint texel = (j * k_alpha_count + uint(i)) * k_texels_per_ray + (bit >> 7);
    uvec4 words = texelFetch(grid_texels, int(texel));
    is_lit = is_lit && (words[bit >> 5 & 3u] >> (bit & 31u) & 1u) == 0u;
  }
  visibility = is_lit ? 1.0 : 0.0;
}
