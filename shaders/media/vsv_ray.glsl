// What the VSV integrators share: a view ray in the grid. GLSL only.
#include "media/medium_ray.glsl"
#include "epipolar/grid_texels.glsl"
#include "epipolar/phi_range.glsl"
#include "epipolar/change_tree.glsl"
#include "media/row_end.glsl"
#include "frame/ray_place.glsl"

// Whether a voxel is dark as soon as a triangle touches it, or only where its centre is in shadow.
layout(constant_id = 8) const uint k_whole_voxels = 0;
// Whether view rays of the frame look away from the light.
layout(constant_id = 11) const uint k_looks_away = 0;
// What tells what lies along view rays: the bits, the tree (epipolar/change_tree.glsl), or the first shadowed cells of light rays.
layout(constant_id = 17) const uint k_query = 0;
const uint k_tree = 1u;
const uint k_light_rays = 2u;

layout(binding = k_surface_unit) uniform sampler2D surface_image;
layout(location = 0) out vec4 airlight;

// How far before the plane, in cells of φ, a bit has to lie to be trusted.
const float k_plane_slack = 0.25;
// The same where whole voxels are dark, from the first point of the voxel at which the surface touches it.
const float k_touch_slack = 0.25;
// Of lengths: what voxelization adds to a triangle for single precision and for the curvature of a slab (conservative.glsl).
// Where a wall is seen and lit at a grazing angle its voxels reach far before it.
const float k_length_slack = 1e-4;

// Whether a cell of a row of α is in shadow. Not of a tree.
bool is_dark(uint plane, uint row, uint cell) {
  if (k_query == k_light_rays) {
    uvec4 first = texelFetch(grid_texels, int(plane * (k_phi_count / 4u) + (cell >> 2)));
    return component_of(first, cell & 3u) <= row;
  }
  return is_bit_set(plane, row, cell);
}

struct VsvRay {
  MediumRay seen;
  PhiCells cells;
  float end;         // where the ray ends, in cells of φ
  uint last_cell;    // the cell that holds its end
  int last_valid;    // the last cell whose bit says something about this ray; −1 for none
  uint beyond_valid; // all bits set or none: what cells after that one hold
  uint plane;        // its half-plane …
  uint row;          // … and row of α
};

// Before the first cell that may say something: whether the row of α at π/2 is dark in the first one.
bool is_dark_beside_eye(uint plane) {
  uint row = alpha_cell(space, 0.5 * k_pi, k_alpha_count);
  if (k_query == k_tree) {
    uint leaf = plane * nodes_per_plane(k_phi_count) + level_start(tree_levels(k_phi_count) - 1u);
    return (texelFetch(grid_texels, int(leaf)).x & 0xffffu) <= row;  // what lies before its first light ray is lit
  }
  return is_dark(plane, row, 0u);
}

VsvRay vsv_ray(ivec2 texel) {
  VsvRay ray;
  vec4 surface = texelFetch(surface_image, texel, 0);
  ray.seen = medium_ray(ray_place(texel), surface.w);
  vec3 direction = ray.seen.direction;
  uint i = alpha_cell(space, ray.seen.alpha, k_alpha_count);
  float theta = theta_of(space, direction);
  uint j = theta_cell(space, theta, k_theta_count);
  ray.cells = phi_cells(j);
  ray.end = cell_of_phi(ray.cells, ray.seen.phi_end);
  ray.last_cell = uint(clamp(floor(ray.end), 0.0, float(k_phi_count) - 1.0));
  ray.plane = j;
  ray.row = i;

  // The bits are those of the row's own ray, at the centre of its cell. Where that ray meets the surface's plane before this one
  // ends, its later bits tell of the other side of the surface: beyond a wall between eye and light they are lit, and as
  // 1/sin α grows a leak would circle the epipole.
  ray.last_valid = int(ray.last_cell);
  ray.beyond_valid = 0u;
  if (ray.seen.distance == surface.w) {
    float d_theta = theta_to_centre(space, theta, j);
    float before;  // the last cell that the surface leaves alone
    if (k_whole_voxels != 0u) {
      // The surface itself makes its voxels dark, first where α is largest and at one of the plane's borders.
      float half_plane = 0.5 * space.theta_step / (1.0 + space.theta_growth * cosine(theta_from_middle(space, theta)));
      float nearer = k_length_slack * max(surface.w, space.distance);
      float d_alpha = alpha_of_cell(space, float(i + 1u)) - ray.seen.alpha;
      float d_phi = min(phi_to_row_end(space, ray.seen.angle, direction, surface, d_alpha, d_theta - half_plane, nearer),
                        phi_to_row_end(space, ray.seen.angle, direction, surface, d_alpha, d_theta + half_plane, nearer));
      before = floor(cell_of_phi(ray.cells, max(ray.seen.phi_end + d_phi, 0.0)) - k_touch_slack) - 1.0;
    } else {
      // Half a texel of the shadow map, at the surface, is how far beside the light ray its depth may have been taken.
      vec3 way = to_light(light, surface.w * direction);
      float nearer = light.half_texel * (is_sun(space) ? 1.0 : length(way) * space.inverse_distance);
      float d_alpha = alpha_of_cell(space, float(i) + 0.5) - ray.seen.alpha;
      float d_phi = phi_to_row_end(space, ray.seen.angle, direction, surface, d_alpha, d_theta, nearer);
      before = ceil(cell_of_phi(ray.cells, max(ray.seen.phi_end + d_phi, 0.0)) - 0.5 - k_plane_slack) - 1.0;
    }
    ray.last_valid = int(clamp(before, -1.0, float(ray.last_cell)));
    // The cells after it are like it. Where there is none they are lit where the surface faces the light, but for what looks away
    // from the light and ends within its first cell, on the light rays next to the eye: that is as dark as they are beside the eye.
    bool is_beyond_dark = false;
    if (ray.last_valid < 0) {
      is_beyond_dark = light_above(light, surface.xyz, surface.w * dot(surface.xyz, direction)) <= 0.0;
      if (k_looks_away != 0u) {
        if (ray.seen.angle.cosine < 0.0 && !is_beyond_dark) is_beyond_dark = is_dark_beside_eye(j);
      }
    } else if (k_query != k_tree) {
      is_beyond_dark = is_dark(j, i, uint(ray.last_valid));
    }
    ray.beyond_valid = is_beyond_dark ? 0xffffffffu : 0u;
  }
  return ray;
}

// Whether the grid ends before the ray, where all is lit; by more than the rounding of either's end.
bool goes_beyond(VsvRay ray) { return ray.end > float(k_phi_count) + 0.05; }

// How many texels of its row of bits a ray reads.
uint texel_count(VsvRay ray) { return ray.end < 0.0 ? 0u : (ray.last_cell >> 7) + 1u; }

// Of the 128 bits of a texel those of the row's first `count` cells.
uvec4 first_cells(int count, uint texel) {
  ivec4 bits = clamp(ivec4(count - int(128u * texel)) - ivec4(0, 32, 64, 96), 0, 32);
  // A shift by 32 has no value.
  return uvec4(lessThan(bits, ivec4(32))) * (uvec4(1u) << uvec4(bits & 31)) - 1u;
}

// Those that lie before the ray's end, all or in part.
uvec4 before_end(VsvRay ray, uint texel) { return first_cells(int(ray.last_cell) + 1, texel); }

// The 128 bits of a texel as this ray sees them.
uvec4 seen_bits(VsvRay ray, uint texel) {
  uvec4 valid = first_cells(ray.last_valid + 1, texel);
  return (grid_bits(ray.plane, ray.row, texel) & valid) | (ray.beyond_valid & ~valid);
}

// Where visibility changes: the bits that differ from the cell before. `last`: that cell's, of the first bit, and then of the next texel's.
uvec4 changes_of(uvec4 shadow, inout uint last) {
  uvec4 before = shadow << 1 | uvec4(last, shadow.xyz >> 31);
  last = shadow.w >> 31;
  return shadow ^ before;
}

// The number in its texel of the lowest set bit, of which there is one; clears it.
uint take_lowest(inout uvec4 bits) {
  uint word = bits.x != 0u ? 0u : bits.y != 0u ? 1u : bits.z != 0u ? 2u : 3u;
  uint of_word = bits.x != 0u ? bits.x : bits.y != 0u ? bits.y : bits.z != 0u ? bits.z : bits.w;
  uint rest = of_word & (of_word - 1u);
  bits.w = word == 3u ? rest : bits.w;
  bits.z = word == 2u ? rest : bits.z;
  bits.y = word == 1u ? rest : bits.y;
  bits.x = word == 0u ? rest : bits.x;
  return 32u * word + uint(findLSB(of_word));
}

// The changes of visibility along a ray, one after the other.
struct Changes {
  uint texel;  // of bits: the next to be read, …
  uvec4 bits;  // … the changes that are left of the one before, …
  uint last;   // … and whether its last cell is in shadow. What lies before the first texel counts as lit.
  uint open;   // of the tree: four bits a level, the straddled children of the nodes on the way that are still to be gone into, …
  uint cell;   // … and where the way has come to
  uint reads;  // texels or nodes so far (vsv_count.frag)
};

// Which of a node's children a ray straddles, a bit each.
uint straddled(VsvRay ray, uint level, uint n) {
  uint root = ray.plane * nodes_per_plane(k_phi_count);
  // The tree takes the place of the grid.
  uvec4 node = texelFetch(grid_texels, int(root + level_start(tree_levels(k_phi_count) - 1u - level) + n));
  uvec4 changes = uvec4(lessThanEqual(node & 0xffffu, uvec4(ray.row))) & uvec4(greaterThan(node >> 16, uvec4(ray.row)));
  return changes.x | changes.y << 1 | changes.z << 2 | changes.w << 3;
}

Changes changes_along(VsvRay ray) {
  Changes changes = Changes(0u, uvec4(0u), 0u, 0u, 0u, 0u);
  if (k_query == k_tree) {
    uint top = tree_levels(k_phi_count) - 1u;
    // Where no cell says anything, the first one changes or none does.
    uint of_none = ray.beyond_valid & 1u;
    uint of_root = straddled(ray, top, 0u) << 4u * top;
    changes.reads = 1u;
    changes.open = ray.end < 0.0 ? 0u : ray.last_valid < 0 ? of_none : of_root;
  }
  return changes;
}

bool has_changes(VsvRay ray, Changes changes) {
  if (k_query == k_tree) return changes.open != 0u;
  return changes.bits != uvec4(0u) || changes.texel < texel_count(ray);
}

// The cell before which visibility changes next, or k_phi_count.
uint next_change(VsvRay ray, inout Changes changes) {
  uint found = k_phi_count;
  if (k_query == k_tree) {
    int last = max(ray.last_valid, 0);
    while (found == k_phi_count && changes.open != 0u) {
      uint bit = uint(findLSB(changes.open));
      changes.open &= changes.open - 1u;
      uint level = bit >> 2;
      uint shift = 2u * level;
      changes.cell = changes.cell >> (shift + 2u) << (shift + 2u) | (bit & 3u) << shift;
      if (int(changes.cell) > last) {
        changes.open = 0u;
      } else if (level == 0u) {
        found = changes.cell;
      } else {
        changes.open |= straddled(ray, level - 1u, changes.cell >> shift) << (4u * level - 4u);
        ++changes.reads;
      }
    }
  } else {
    while (changes.bits == uvec4(0u) && changes.texel < texel_count(ray)) {
      changes.bits = changes_of(seen_bits(ray, changes.texel), changes.last) & before_end(ray, changes.texel);
      ++changes.texel;
      ++changes.reads;
    }
    if (changes.bits != uvec4(0u)) found = 128u * (changes.texel - 1u) + take_lowest(changes.bits);
  }
  return found;
}
