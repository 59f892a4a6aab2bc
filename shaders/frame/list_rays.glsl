// Puts members of a group on the list of rays. GLSL only.
#include "frame/ray_list_block.glsl"

layout(std430, binding = k_ray_list_storage) buffer RayListStorage { RayListBlock rays; };
layout(std430, binding = k_ray_members_storage) writeonly buffer RayMembers { uint members[]; };
layout(std430, binding = k_ray_groups_storage) writeonly buffer RayGroups { RayGroup groups[]; };

// The first of as many rays. In which order groups come is left to chance: nothing depends on it.
uint take_rays(uint count) {
  return count > 0u ? atomicAdd(rays.count, count) : 0u;
}
