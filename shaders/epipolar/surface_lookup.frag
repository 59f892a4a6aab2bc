#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/uniforms.glsl"
#include "frame/shadow_cube.glsl"
#include "epipolar/grid_texels.glsl"
#include "epipolar/phi_range.glsl"

// Is a pixel's surface lit? One bit of the shadow volume tells: that of the last voxel in front of the surface, on the light ray
// that is nearest to the surface's point.
layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(location = 0) out float visibility;

// Whether a voxel is dark as soon as a triangle touches it, or only where its centre is in shadow.
layout(constant_id = 3) const bool k_whole_voxels = false;
layout(constant_id = 4) const bool k_plane = false;  // the shadow map is on a plane

// How far a light ray may pass from the texel of the shadow map that answered for it [texels]: half a texel's diagonal, and a
// quarter more for a surface that bends between the two (surface_shadows/shadow_map_lookup.frag).
const float k_texel_reach = 0.96;
// Of a cell of α: what single precision leaves of a plane that a light ray grazes.
const float k_rounding = 0.02;
// Of lengths: what voxelization adds to a triangle for single precision and for the curvature of a slab (conservative.glsl).
const float k_length_slack = 1e-4;

// Half the widest cell of θ.
float half_slab() { return 0.5 * space.theta_step / (1.0 - space.theta_growth); }

float length_slack(vec4 surface) { return k_whole_voxels ? k_length_slack * max(surface.w, space.distance) : 0.0; }

// One of the grid.
struct LightRay {
  float phi;
  vec3 outward;  // from the axis, in the ray's half-plane
};

// α where the ray, or one that the grid may have taken for it, first meets the surface's plane: there the surface's own shadow
// begins. Seen from eye and light on its lit side, a plane has the smaller α the larger φ is.
float alpha_of_own_shadow(LightRay ray, vec4 surface, float offset) {
  float sin_phi = sine(ray.phi);
  float cos_phi = cosine(ray.phi);
  vec3 direction = sin_phi * ray.outward - cos_phi * space.axis;
  float plane = offset - dot(surface.xyz, light.from_eye);  // its distance from the light, < 0
  CubePoint towards_cube = cube_point(direction);
  float along_face = surface[towards_cube.face >> 1];
  float spread = k_whole_voxels ? half_slab() * sin_phi * abs(dot(surface.xyz, cross(space.axis, ray.outward)))
                                : k_texel_reach * 2.0 / light.shadow_map_size * towards_cube.depth *
                                      sqrt(max(1.0 - along_face * along_face, 0.0));
  float near = plane + length_slack(surface);
  float r = min(near, 0.0) / min(dot(surface.xyz, direction) - spread, -1e-20);
  return alpha_at(space, sin_phi, cos_phi, r);
}

// The same where the shadow map is on a plane, and on its map (frame/shadow_plane.glsl), where light rays are parallels of the axis.
float alpha_of_own_shadow_on_plane(LightRay ray, vec4 surface, float offset) {
  float across = crossing_of(space, ray.phi);
  vec3 normal = surface.xyz - offset * light.inverse_distance * light.axis;
  float facing = dot(normal, light.axis);
  vec3 along_map = normal - facing * light.axis;
  float spread = k_whole_voxels ? half_slab() * across * abs(dot(normal, cross(space.axis, ray.outward)))
                                : k_texel_reach * 2.0 * light.half_texel * length(along_map);
  float z = (offset + length_slack(surface) + spread - across * dot(normal, ray.outward)) / max(facing, 1e-20);
  return angle_of(across, z);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 surface = texelFetch(surface_image, pixel, 0);
  vec3 direction = view_ray(camera, vec2(pixel) + 0.5);
  EyeAngle angle = eye_angle(space, direction, quarter_pixel(camera));

  // The light ray whose cell holds the surface's point.
  uint j = theta_cell(space, theta_of(space, direction), k_theta_count);
  PhiCells cells = phi_cells(j);
  float k = clamp(floor(cell_of_phi(cells, phi_at(space, angle, surface.w))), 0.0, float(k_phi_count) - 1.0);
  vec2 of_plane = plane_direction(j);
  LightRay ray = LightRay(phi_of_cell(cells, k + (k_whole_voxels ? 1.0 : 0.5)),
                          of_plane.x * space.u + of_plane.y * space.f);

  float offset = surface.w * dot(surface.xyz, direction);
  float alpha = k_plane ? alpha_of_own_shadow_on_plane(ray, surface, offset) : alpha_of_own_shadow(ray, surface, offset);
  float own = cell_of_alpha(space, alpha) - k_rounding;
  float before = k_whole_voxels ? floor(own) - 1.0 : ceil(own - 0.5) - 1.0;
  float i = min(before, float(alpha_cell(space, alpha_of(angle), k_alpha_count)));

  bool is_lit = light_above(light, surface.xyz, offset) > 0.0;  // a surface that faces away is dark
  if (i >= 0.0) is_lit = is_lit && !is_bit_set(j, uint(i), uint(k));
  visibility = is_lit ? 1.0 : 0.0;
}
