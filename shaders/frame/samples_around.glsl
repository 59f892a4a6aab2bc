// The epipolar samples about a pixel. GLSL only.
#include "frame/epipolar_lines.glsl"
#include "frame/uniforms.glsl"

// Of the nearer one's 1/depth: by how much a sample may lie before or behind the pixel's plane to be alike.
const float k_alike = 0.03;

struct SamplesAround {
  ivec2 texels[4];     // sample and slice
  float shares[4];     // of linear interpolation, along slices and between them
  float depths[4];     // 1/depth of the pixel's plane there, …
  float depth;         // … and where the pixel sees it
  float from_epipole;  // [pixels]; of parallel lines 1e30
};

SamplesAround samples_around(uint slices, uint samples, vec2 place, vec4 surface) {
  SamplesAround around;
  SeenPlane plane = seen_plane(camera, place, surface.xyz, surface.w);
  around.depth = plane.at;
  EpipolarLines lines = epipolar_lines(camera, light.axis);
  vec2 way = place * lines.epipole.z - lines.epipole.xy;
  around.from_epipole = length(way) / max(lines.epipole.z, 1e-30);
  float intervals = slice_intervals(lines, slices);
  float at = line_end(lines, place) * intervals;
  float first_slice = min(floor(at), intervals - 1.0);
  for (uint i = 0u; i < 2u; ++i) {
    uint slice = uint(first_slice) + i;
    if (slice >= slices) slice = 0u;
    EpipolarLine line = slice_line(lines, slice, slices);
    float along = sample_beside(line, place, samples);
    float first_sample = min(floor(along), float(samples) - 2.0);
    float of_slice = i == 0u ? 1.0 - (at - first_slice) : at - first_slice;
    for (uint j = 0u; j < 2u; ++j) {
      float sample_number = first_sample + float(j);
      float of_sample = j == 0u ? 1.0 - (along - first_sample) : along - first_sample;
      around.texels[2u * i + j] = ivec2(sample_number, slice);
      around.shares[2u * i + j] = of_slice * of_sample;
      around.depths[2u * i + j] = inverse_depth_at(plane, sample_place(line, sample_number, samples) - place);
    }
  }
  return around;
}

// Whether sample i of them, of that 1/depth, sees what the pixel sees, or something as deep.
bool is_alike(SamplesAround around, uint i, float depth) {
  return abs(depth - around.depths[i]) <= k_alike * max(depth, around.depth);
}
