// Calls every function that the shaders share with C++, on one set of inputs: on the GPU and on the CPU.
#ifndef AIRLIGHT_EVERY_FUNCTION_GLSL
#define AIRLIGHT_EVERY_FUNCTION_GLSL
#include "frame/footprint.glsl"
#include "frame/light_texture.glsl"
#include "frame/octahedron.glsl"
#include "frame/shadow_cube.glsl"
#include "frame/shadow_plane.glsl"
#include "frame/camera.glsl"
#include "frame/texture_filter.glsl"
#include "epipolar/conservative.glsl"
#include "media/froxels.glsl"
#include "media/march_steps.glsl"
#include "media/medium.glsl"
#include "media/reach.glsl"
#include "media/row_end.glsl"
#include "media/sun.glsl"
#include "media/table_place.glsl"

CONST uint k_outputs = 217u;

struct Inputs {
  vec4 a;  // axis, D
  vec4 b;  // unit view ray, distance t along it
  vec4 c;  // α, θ, φ, π − α
  vec4 d;  // any vector, phase function's g
};

struct Outputs {
  float values[k_outputs];
};

// Where the next value goes, and all before it. Of the whole invocation: handed down as parameters from function to function, an element
// of an array is an "lvalue too complex" for NVIDIA's compiler.
PRIVATE Outputs outputs;
PRIVATE uint at;

FUNCTION void put(float value) {
  outputs.values[at] = value;
  at += 1u;
}

FUNCTION void put(IN(vec3) value) {
  put(value.x);
  put(value.y);
  put(value.z);
}

FUNCTION void put(IN(vec2) value) {
  put(value.x);
  put(value.y);
}

FUNCTION void put(IN(PlaneSpan) span) {
  put(float(span.first));
  put(float(span.count));
  put(float(span.wrapped_first));
  put(float(span.wrapped_count));
}

FUNCTION void put(IN(SlabOutline) outline) {
  for (int i = 0; i < 5; ++i) {
    put(outline.segment[i].x);
    put(outline.segment[i].y);
    put(outline.segment[i].z);
    put(outline.segment[i].w);
  }
}

// Not in a loop: a compiler that leaves one as it is no longer knows where the values after it go, which costs it minutes.
FUNCTION void put_cells_of_alpha(INOUT(EpipolarBlock) space, float spacing, Angle alpha) {
  space.alpha_spacing = spacing;
  put(spaced_alpha(space, alpha));
  put(float(cell_of_alpha(space, alpha)));
  put(float(alpha_of_cell(space, Cell(80.0f * float(alpha)))));
}

FUNCTION void call_every_function(IN(Inputs) inputs) {
  for (uint i = 0u; i < k_outputs; ++i) outputs.values[i] = 0.0f;
  vec3 l = vec3(inputs.a.x, inputs.a.y, inputs.a.z);
  vec3 ray = vec3(inputs.b.x, inputs.b.y, inputs.b.z);
  float t = inputs.b.w;
  Angle alpha = Angle(inputs.c.x);
  Angle theta = Angle(inputs.c.y);
  Angle phi = Angle(inputs.c.z);
  Angle complement = Angle(inputs.c.w);
  vec3 any_vector = vec3(inputs.d.x, inputs.d.y, inputs.d.z);
  float g = inputs.d.w;

  EpipolarBlock space;
  space.axis = l;
  space.distance = inputs.a.w;
  space.inverse_distance = 1.0f / inputs.a.w;
  // Any pair at right angles will do; this one has no branch.
  space.u = normalize(cross(l, vec3(0.1f, 0.7f, -0.3f)));
  space.f = cross(l, space.u);
  space.alpha_min = Angle(0.3f);
  space.alpha_step = 0.005f;
  space.alpha_spacing = k_equal_alpha;
  space.own_ranges = 0.0f;
  space.unused = 0.0f;
  space.theta_middle = Angle(0.5f);
  space.theta_half = Angle(3.0f);
  space.theta_growth = 0.3f;
  space.theta_step = Angle(6.0f / 333.0f);

  MediumBlock medium;
  medium.sigma_s = vec3(0.1f, 0.2f, 0.3f);
  medium.g = g;
  medium.sigma_t = vec3(0.15f, 0.2f, 0.4f);
  medium.rayleigh_weight = 0.3f;
  medium.top = k_no_top;
  medium.unused_0 = medium.unused_1 = medium.unused_2 = 0.0f;

  LightBlock light;
  light.from_eye = 2.0f * l;
  light.is_near = 1.0f;
  light.near = 0.1f;
  light.intensity = vec3(5.0f, 6.0f, 7.0f);
  light.shadow_map_size = 512.0f;
  light.depth_scale = 0.05f;
  light.depth_offset = 0.4f;
  light.half_texel = 0.01f;
  light.image_x = vec4(space.u / 3.0f, 0.1f);
  light.image_y = vec4(space.f / 2.0f, -0.2f);
  light.axis = l;
  light.inverse_distance = space.inverse_distance;
  light.cone_axis = unit_or(any_vector - l, l);
  light.cone_outer = 0.9f;
  light.cone_ramp = 4.0f;
  light.inverse_range = 0.3f * space.inverse_distance;
  light.unused_0 = light.unused_1 = 0.0f;

  CameraBlock camera;
  camera.eye_high = 100.0f * ray;
  camera.half_width = 0.7f;
  camera.eye_low = 1e-6f * ray;
  camera.half_height = 0.4f;
  camera.right = space.u;
  camera.image_width = 320.0f;
  camera.up = space.f;
  camera.image_height = 200.0f;
  camera.forward = l;
  camera.near = 0.1f;

  at = 0u;
  EyeAngle angle = eye_angle(space, ray, 1e-4f);
  put(angle.sine);
  put(angle.cosine);
  put(float(alpha_of(angle)));
  put(float(alpha_complement(angle)));
  put(float(theta_of(space, ray)));
  put(float(phi_at(space, angle, t)));
  EyeAngle given;
  given.sine = sine(alpha);
  given.cosine = cosine(alpha);
  put(float(alpha_at(space, sine(phi), cosine(phi), t)));
  put(path_length(space, complement, phi));
  put(float(angle_order(abs(t * ray.x), t * ray.y)));
  put(float(angle_from_order(Order(0.6f * float(alpha)))));
  put(float(theta_centre(space, uint(100.0f * float(alpha)))));
  put(float(theta_cell(space, theta, 333u)));
  put(float(alpha_cell(space, alpha, 512u)));
  put(float(first_shadowed_cell(space, alpha, 512u)));
  put(float(grid_word(uint(100.0f * float(alpha)), uint(100.0f * float(phi)), 3u, 512u, 16u)));
  float half_sine = sine_of_quarter(0.5f * phi);
  float half_cosine = cosine(0.5f * phi);
  put(phase_function(k_isotropic, medium, half_sine, half_cosine));
  put(phase_function(k_rayleigh, medium, half_sine, half_cosine));
  put(phase_function(k_henyey_greenstein, medium, half_sine, half_cosine));
  put(phase_function(k_hoffman_preetham, medium, half_sine, half_cosine));
  put(airlight_integrand(space, medium, k_henyey_greenstein, complement, phi));
  put(integrate_cell(space, medium, k_rayleigh, complement, 0.9f * phi, phi));
  put(float(smooth_length(space, medium, k_henyey_greenstein, complement, phi)));
  put(integrate_run(space, medium, k_henyey_greenstein, complement, 0.5f * phi, phi));
  put(table_place(alpha));
  put(float(complement_at(0.6f * float(alpha))));
  put(airlight_scale(space, light, medium, given.sine));
  CubePoint point = cube_point(any_vector);
  put(float(point.face));
  put(point.uv.x);
  put(point.uv.y);
  put(point.depth);
  put(cube_direction(point.face, point.uv));
  ivec2 texel = cube_texel(point.uv, 512.0f);
  put(float(texel.x));
  put(float(texel.y));
  vec2 centre = cube_texel_centre(texel, 512.0f);
  put(centre.x);
  put(centre.y);
  put(view_ray(camera, vec2(100.0f * float(alpha), 60.0f * float(phi))));
  put(quarter_pixel(camera));
  PRECISE vec3 world = 100.0f * ray + 0.01f * any_vector;
  put(eye_relative(camera, world));
  put(ray_triangle_distance(l, t * l + space.u, t * l - 2.0f * space.f, 2.0f * t * l - space.u + space.f));
  PhiCells cells = shared_cells(complement, 1.0f + g, Cell(512.0f));
  put(float(phi_of_cell(cells, Cell(100.0f * float(alpha)))));
  put(float(cell_of_phi(cells, phi)));
  vec2 place = light_texture_place(float(theta), 0.5f * float(theta));
  put(place.x);
  put(place.y);
  TexelBlend blend = light_texture_blend(place, ivec2(40, 20));
  put(vec3(blend.from.x, blend.from.y, 0.0f) + vec3(blend.weight.x, blend.weight.y, 0.0f));
  put(vec3(blend.to.x, blend.to.y, 0.0f) + vec3(blend.weight.x, blend.weight.y, 0.0f));

  put(sine(4.0f * theta));
  put(cosine(4.0f * theta));
  put(sine_of_quarter(0.5f * theta));
  put(float(angle_of(ray.x, ray.y)));
  put(ordered_dot(ray, l));
  put(unit_or(any_vector, l));
  put(float(plane_of_theta(space, theta)));
  put(float(theta_of_plane(space, Cell(100.0f * float(alpha)))));
  put(float(theta_from_middle(space, theta)));
  put(float(theta_to_centre(space, theta, 10u)));
  vec4 surface = vec4(-ray + 0.3f * l, t);
  put(float(phi_to_row_end(space, angle, ray, surface, Angle(0.002f), Angle(-0.001f), 0.0f)));

  // A triangle in front of the eye, of the size of its distance.
  vec3 a = t * ray;
  vec3 b = a + 0.5f * t * space.u;
  vec3 c = a + 0.7f * t * space.f + 0.1f * t * l;
  put(float(slabs_per_plane(space)));
  float slack = position_slack(space, a, b, c);
  put(slack);
  put(distance_to_segment(vec2(ray.x, ray.y), vec2(any_vector.x, any_vector.y)));
  put(float(wrapped(2.0f * theta)));
  VoxelTriangle triangle = voxel_triangle(space, a, b, c, 333u);
  put(triangle.a);
  put(triangle.planes);
  put(float(plane_at(triangle.planes, 0u)));
  vec2 range = clip(vec2(0.0f, 1.0f), ray.x, g);
  put(range.x);
  put(range.y);
  float plane = float(plane_at(triangle.planes, plane_count(triangle.planes) / 2u));
  Angle middle = theta_of_plane(space, Cell(plane + 0.5f));
  SlabPart part = part_in_slab(space, cells, triangle, middle - Angle(0.01f), middle + Angle(0.01f));
  put(part.outline);
  put(curvature_slack(part.outline, 0.01f));
  vec2 orders = phi_order_bounds(space, part.outline, slack);
  put(orders.x);
  put(orders.y);
  put(float(part.first_ray));
  put(float(part.end_ray));
  vec3 from_ray = boundary_ray(space, cells, 0u);
  vec3 to_ray = boundary_ray(space, cells, 511u);
  put(to_ray.x);
  put(to_ray.y);
  put(float(least_alpha_order(space, part.outline, from_ray, to_ray, slack)));
  put(float(first_touched_cell(space, part, from_ray, to_ray, 512u)));

  // Both kinds of light.
  EpipolarBlock sun_space = space;
  sun_space.distance = 0.0f;
  sun_space.inverse_distance = 0.0f;
  put(float(phi_through(space, 0.3f * t, 0.7f)));
  put(float(phi_at(sun_space, angle, t)));
  put(float(phi_of_end(space, angle, t, true)));
  put(crossing_of(space, 0.4f * phi));
  put(crossing_of(sun_space, phi));
  put(float(phi_order_at(space, angle, t)));
  put(float(phi_order_at(sun_space, angle, t)));
  put(float(phi_order_of_open_end(space, angle)));
  put(float(phi_from_order(space, Order(0.6f * float(alpha)))));
  put(float(phi_from_order(sun_space, Order(t))));
  put_cells_of_alpha(space, k_equal_alpha, alpha);
  put_cells_of_alpha(space, k_root_of_alpha, alpha);
  put_cells_of_alpha(space, k_root_of_complement, alpha);
  PhiCells own = own_cells(complement, 1.0f + g, Cell(512.0f), 0.3f * complement, 0.6f * complement);
  put(own.first);
  put(own.per_cell);
  put(float(phi_of_cell(own, Cell(100.0f * float(alpha)))));
  put(float(cell_of_phi(own, phi)));

  put(to_light(light, a));
  put(light_above(light, ray, g));
  // A layer whose top lies above the eye or below it; a lamp and a sun above its top.
  MediumBlock layer = medium;
  layer.top = g;
  LightBlock lamp = light;
  lamp.from_eye = 2.0f * l + vec3(0.0f, 4.0f, 0.0f);
  LightBlock sun = light;
  sun.is_near = 0.0f;
  sun.from_eye = normalize(vec3(l.x, abs(l.y) + 0.2f, l.z));
  put(part_in_medium(layer, ray.y, t));
  put(light_path(layer, lamp, ray));
  put(light_path(layer, sun, ray));
  put(plane_share(light, a));
  put(plane_uv(light, a));
  vec4 clip_point = plane_clip(light, a);
  put(vec3(clip_point.x, clip_point.y, clip_point.z));
  put(clip_point.w);
  put(plane_z(light, 0.25f * float(alpha)));
  SunRay sun_ray_of_layer = sun_ray(layer, sun, ray, t);
  put(sun_ray_of_layer.entry);
  put(sun_ray_of_layer.exit);
  put(sun_ray_of_layer.path);
  put(sun_ray_of_layer.slope);
  put(mean_decay(t));
  SunRay falling;
  falling.entry = 0.0f;
  falling.exit = t;
  falling.path = t;
  falling.slope = g;
  put(integrate_sun_run(medium, falling, 0.2f * t, 0.9f * t));
  put(sun_scale(light, medium, k_henyey_greenstein, alpha));

  // What panels follow; a lamp above a layer; a spot with a range.
  float growth = depth_growth(space, 0.2f, complement, phi);
  put(growth);
  put(float(panel_length_by_growth(medium, k_hoffman_preetham, complement, phi, growth)));
  put(float(straight_length_by_growth(medium, k_hoffman_preetham, complement, phi, growth)));
  LayerRay in_layer;
  in_layer.direction = ray;
  in_layer.outward = unit_or(ray - dot(ray, l) * l, space.u);
  in_layer.alpha = alpha;
  in_layer.complement = complement;
  in_layer.entry = 0.0f;
  put(float(sine_of_scattering(in_layer, phi)));
  put(cone_share(light, ray));
  put(range_share(light, t));
  put(float(half_width_of_cone(light.cone_outer, 0.5f * g)));
  LitPart part_lit = part_in_reach(space, light, k_reach_of_cone, in_layer, Angle(0.0f), complement);
  put(float(part_lit.from));
  put(float(part_lit.to));
  put(float(part_lit.inner_from));
  put(float(part_lit.inner_to));
  part_lit = part_in_reach(space, light, k_reach_of_range, in_layer, Angle(0.0f), complement);
  put(float(part_lit.from));
  put(float(part_lit.to));
  put(reach_share(space, light, k_reach_of_cone, in_layer, phi));

  // A march whose steps go beyond the scene.
  MarchSteps steps = march_steps(0.1f * t, k_endless, t, 40.0f);
  put(steps.near_to);
  put(steps.near_count);
  put(place_of_step(steps, 12.0f * float(alpha)));
  put(interleaved_offset(ivec2(int(100.0f * float(alpha)), int(100.0f * float(phi)))));
  put(depth_of_slice(20.0f * float(alpha), 64.0f, t));
  put(slice_of_depth(0.3f * float(alpha) * t, 64.0f, t));
  put(place_in_froxel(uint(20.0f * float(alpha))));
  put(place_in_slices(camera, t * view_ray(camera, vec2(100.0f * float(alpha), 60.0f * float(phi))), 64.0f, 3.0f * t));

  // Looks.
  put(fold(3.0f * float(theta), k_wrap_repeat));
  put(fold(3.0f * float(theta), k_wrap_clamp));
  put(fold(3.0f * float(theta), k_wrap_mirror));
  blend = texture_blend(vec2(3.0f * float(theta), float(alpha)), ivec2(40, 20), uvec2(k_wrap_repeat, k_wrap_mirror));
  put(vec3(blend.from.x, blend.from.y, 0.0f) + vec3(blend.weight.x, blend.weight.y, 0.0f));
  put(vec3(blend.to.x, blend.to.y, 0.0f) + vec3(blend.weight.x, blend.weight.y, 0.0f));
  TextureProbes probes = texture_probes(vec2(ray.x, ray.y), vec2(0.1f * l.x, l.y), ivec2(40, 20));
  put(float(probes.count));
  put(probes.level);
  put(probes.apart.x);
  TextureLevel level = texture_level(7u, ivec2(40, 20), int(float(alpha)));
  put(vec3(store_place(level.first, level.size.x, ivec2(3, 2))));
  put(float(last_level(level.size)));
  put(of_octahedron(octahedron_of(ray)));
  vec3 ab = 0.5f * t * space.u;
  put(weights_per_turn(l, 1e-3f * space.f, t * l, t * l + ab, t * l + 0.3f * t * space.f + 0.1f * ab));
}

#endif
