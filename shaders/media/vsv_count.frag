#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/vsv_ray.glsl"

// What a view ray costs, whatever the machine: its changes of visibility, and how many texels of bits or nodes of the tree are read to
// find them.
void main() {
  VsvRay ray = vsv_ray(ivec2(gl_FragCoord.xy));
  Changes changes = changes_along(ray);
  float count = 0.0;
  while (has_changes(ray, changes)) {
    if (next_change(ray, changes) < k_phi_count) count += 1.0;
  }
  airlight = vec4(count, float(changes.reads), 0.0, 1.0);
}
