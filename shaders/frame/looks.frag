#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame/base_colour.glsl"
#include "frame/footprint.glsl"
#include "frame/octahedron.glsl"
#include "frame/uniforms.glsl"

// What each pixel's surface looks like.
layout(binding = k_triangle_unit) uniform usampler2D triangle_plus_one;
layout(binding = k_positions_unit) uniform samplerBuffer positions;   // vec3, world space
layout(binding = k_triangles_unit) uniform usamplerBuffer triangles;  // uvec3, indices of positions
layout(binding = k_albedos_unit) uniform samplerBuffer albedos;
layout(binding = k_materials_unit) uniform usamplerBuffer material_of_triangle;
layout(binding = k_texture_places_unit) uniform samplerBuffer texture_places;  // vec2, three a triangle
layout(binding = k_normals_unit) uniform usamplerBuffer normals;  // of each triangle's three corners: frame/octahedron.glsl
layout(constant_id = 0) const uint k_has_textures = 0;
layout(constant_id = 1) const uint k_has_normals = 0;
layout(location = 0) out vec4 base_colour;
layout(location = 1) out vec4 shading_normal;  // turned to the side of its triangle that is seen

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint seen = texelFetch(triangle_plus_one, pixel, 0).r;
  base_colour = vec4(0.0);
  shading_normal = vec4(0.0);
  if (seen != 0u) {
    int triangle = int(seen) - 1;
    uvec3 corners = texelFetch(triangles, triangle).xyz;
    vec3 a = eye_relative(camera, texelFetch(positions, int(corners.x)).xyz);
    vec3 b = eye_relative(camera, texelFetch(positions, int(corners.y)).xyz);
    vec3 c = eye_relative(camera, texelFetch(positions, int(corners.z)).xyz);
    vec2 centre = vec2(pixel) + 0.5;
    vec3 ray = view_ray(camera, centre);
    vec3 weights = surface_weights(ray, a, b, c);
    if (k_has_textures != 0u) {
      vec2 place_a = texelFetch(texture_places, 3 * triangle).xy;
      vec2 ab = texelFetch(texture_places, 3 * triangle + 1).xy - place_a;
      vec2 ac = texelFetch(texture_places, 3 * triangle + 2).xy - place_a;
      vec3 per_column = weights_per_turn(ray, view_ray(camera, centre + vec2(1.0, 0.0)) - ray, a, b, c);
      vec3 per_row = weights_per_turn(ray, view_ray(camera, centre + vec2(0.0, 1.0)) - ray, a, b, c);
      int material = int(texelFetch(material_of_triangle, triangle).r);
      base_colour = base_texture(material, place_a + weights.y * ab + weights.z * ac, per_column.y * ab + per_column.z * ac,
                                 per_row.y * ab + per_row.z * ac);
      base_colour.rgb *= texelFetch(albedos, material).rgb;
    }
    if (k_has_normals != 0u) {
      uvec3 packed = texelFetch(normals, triangle).xyz;
      vec3 normal = weighted(weights, of_octahedron(packed.x), of_octahedron(packed.y), of_octahedron(packed.z));
      vec3 own = cross(b - a, c - a);
      shading_normal.xyz = unit_or(dot(own, ray) > 0.0 ? -normal : normal, vec3(0.0));
    }
  }
}
