#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/vsv_ray.glsl"
#include "media/reach.glsl"
#include "media/vsv_colour.glsl"

// Airlight from the shadow volume for whatever light and medium: exact up to the visibility bits, as with a table (vsv_table.frag), but
// each lit run between two changes of visibility is integrated as it is met, by Gauss–Legendre panels that are as long as the
// integrand is smooth, and end where it has kinks: at the edges of a spot's cones, and where its light begins and ends. So nothing has to
// depend on α and φ alone. (Suns have a closed form: vsv_sun.frag.)
layout(constant_id = 4) const uint k_channels = 1;  // 1 where σ_t is grey, else 3
layout(constant_id = 12) const uint k_reach = 0;    // reach.glsl
layout(constant_id = 13) const uint k_light_textured = 0;

// Nodes (to both sides of the middle of [−1, 1]) and weights. Abramowitz and Stegun, Handbook of Mathematical Functions (1964),
// table 25.4.
const vec2 k_of_one = vec2(0.0, 2.0);
const vec2 k_of_two = vec2(0.5773502692, 1.0);
const vec2 k_of_four_inner = vec2(0.3399810436, 0.6521451549);
const vec2 k_of_four_outer = vec2(0.8611363116, 0.3478548451);

// Of what panel_length allows: panels that two nodes, or one, serve as well as four do the whole.
const float k_short = 0.25;
const float k_shortest = 0.02;
// Of the distance to where r would be infinite, ahead and behind: of r⁴ these are steep poles.
const float k_to_far_end = 0.4;
const float k_from_far_end = 0.8;
// Of φ, where the light falls from a spot's inner to its outer cone, on which four nodes are used whatever its width.
const float k_longest_on_edge = 0.5;
// Of all that lies in the outer cone; where the light is textured, a straight line has to follow its fall.
const float k_on_textured_edge = 0.05;
// Of optical depth; what is dimmed by that much more than at the eye counts no more.
const float k_faint = 20.0;

// The lit runs of a ray, one after the other.
struct Runs {
  float lit_from;  // where the next one begins [rad of φ]
  bool has_next;
  Changes changes;
};

// The next lit run's φ. Beyond the half-plane's last cell all is lit.
vec2 next_run(VsvRay ray, inout Runs runs) {
  vec2 run = vec2(runs.lit_from, ray.seen.phi_end);
  uint dark_from = next_change(ray, runs.changes);
  if (dark_from < k_phi_count) run.y = phi_of_cell(ray.cells, float(dark_from));
  uint lit_from = dark_from < k_phi_count ? next_change(ray, runs.changes) : k_phi_count;
  runs.has_next = lit_from < k_phi_count || (dark_from < k_phi_count && goes_beyond(ray));
  runs.lit_from = phi_of_cell(ray.cells, float(lit_from));
  return run;
}

// What a light without texture contributes at φ.
vec3 value_at(LayerRay ray, MediumBlock fog, float phi) {
  vec3 value = k_layer == k_layer_entered ? layer_integrand(space, light, fog, k_phase, ray, phi)
                                          : airlight_integrand(space, fog, k_phase, ray.complement, phi);
  return k_reach == 0u ? value : value * reach_share(space, light, k_reach, ray, phi);
}

// ∫ value_at dφ by one, two or four nodes.
vec3 integrate_panel(LayerRay ray, MediumBlock fog, float from, float to, uint nodes) {
  float middle = 0.5 * (from + to);
  float reach = 0.5 * (to - from);
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < nodes; ++i) {
    vec2 node = nodes == 1u ? k_of_one : nodes == 2u ? k_of_two : i < 2u ? k_of_four_inner : k_of_four_outer;
    sum += node.y * value_at(ray, fog, middle + ((i & 1u) == 0u ? -reach : reach) * node.x);
  }
  return reach * sum;
}

// ∫ value_at times the light's colour. `colours`: its integrals over the panel (vsv_colour.glsl).
vec3 integrate_coloured_panel(LayerRay ray, MediumBlock fog, float from, float to, vec4 colours) {
  float middle = 0.5 * (from + to);
  float offset = 0.5 * k_of_two.x * (to - from);
  vec3 first = value_at(ray, fog, middle - offset);
  vec3 second = value_at(ray, fog, middle + offset);
  // How far from the middle, on the average, light comes from, in units of the nodes' offset.
  float mean = dot(colours.rgb, vec3(1.0 / 3.0));
  float away = mean > 0.0 ? clamp(colours.w / mean - middle, from - middle, to - middle) / max(offset, 1e-30) : 0.0;
  return colours.rgb * max(0.5 * ((first + second) + away * (second - first)), vec3(0.0));
}

void main() {
  VsvRay ray = vsv_ray(ivec2(gl_FragCoord.xy));
  LayerRay view = in_plane(ray.seen);
  MediumBlock fog = medium;
  if (k_channels == 1u) fog.sigma_t = fog.sigma_t.xxx;  // one exponential instead of three
  float lightest = min(fog.sigma_t.x, min(fog.sigma_t.y, fog.sigma_t.z));
  LitPart part = part_in_reach(space, light, k_reach, view, ray.seen.phi_start, ray.seen.phi_end);
  ColourRows rows;
  if (k_light_textured != 0u) rows = colour_rows(theta_of(space, ray.seen.direction));

  vec3 sum = vec3(0.0);
  Runs runs = Runs(0.0, true, changes_along(ray));
  while (runs.has_next) {
    vec2 run = next_run(ray, runs);
    float from = max(run.x, part.from);
    float to = min(run.y, part.to);
    if (run.y >= part.to) runs.has_next = false;
    vec4 colours_to_from;
    if (k_light_textured != 0u) colours_to_from = colours_to(rows, from);
    for (int i = 0; i < k_most_layer_steps && from < to; ++i) {
      float growth;
      float longest = k_pi;
      if (k_layer == k_layer_entered) {
        LayerScales scales = layer_scales(space, light, fog, view, from);
        growth = scales.growth;
        longest = k_panel_psi * scales.to_level;
      } else {
        float detour = path_length(space, view.complement, from) - space.distance;  // what it is longer than at the eye
        if (lightest * detour > k_faint) {
          // Nothing more counts. No break: of loops in loops that are left so, Mesa's lavapipe crashes.
          runs.has_next = false;
          to = from;
        }
        // A channel is followed as long as its light counts beside its own.
        growth = depth_growth(space, steepest_channel(fog, k_dark / k_faint * detour), view.complement, from);
      }
      longest = min(longest, panel_length_by_growth(fog, k_phase, view.complement, from, growth));
      if ((k_reach & k_reach_of_range) != 0u)
        longest = min(longest, min(k_from_far_end * (view.alpha + from), k_to_far_end * (view.complement - from)));
      bool is_on_edge = false;
      if ((k_reach & k_reach_of_cone) != 0u) is_on_edge = from < part.inner_from || from >= part.inner_to;
      if (is_on_edge) longest = min(longest, k_longest_on_edge);
      if (k_light_textured != 0u) {
        longest *= k_straight;
        if (is_on_edge) longest = min(longest, k_on_textured_edge * (part.to - part.from));
        longest = min(longest, straight_length_by_growth(fog, k_phase, view.complement, from, growth));
      }
      float next = min(from + longest, to);
      if ((k_reach & k_reach_of_cone) != 0u) {
        if (from < part.inner_from) next = min(next, part.inner_from);
        else if (from < part.inner_to) next = min(next, part.inner_to);
      }
      float length = next - from;
      uint nodes = is_on_edge || length > k_short * longest ? 4u : length > k_shortest * longest ? 2u : 1u;
      if (k_light_textured != 0u) {
        vec4 colours = colours_to(rows, next);
        sum += integrate_coloured_panel(view, fog, from, next, colours - colours_to_from);
        colours_to_from = colours;
      } else {
        sum += integrate_panel(view, fog, from, next, nodes);
      }
      from = next;
    }
  }
  airlight = vec4(airlight_scale(space, light, medium, ray.seen.angle.sine) * sum, 1.0);
}
