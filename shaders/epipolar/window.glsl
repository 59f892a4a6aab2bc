// What one dispatch over the grid works on. GLSL only.
layout(std140, binding = 4) uniform PassUniform {
  // The run of half-planes whose bits are bound for writing: storage buffers may be smaller than the grid.
  uint window_first_plane;
  uint window_planes;
  // Of the multi-pass scan (mip_scan.glsl), two neighbouring levels: entries in α, and where they start in a plane's chain.
  uint fine_size;
  uint fine_start;
  uint coarse_size;
  uint coarse_start;
  uint chain_size;  // entries of all levels above 0
};
