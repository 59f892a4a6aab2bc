// What the passes over epipolar space are told beside the frame's blocks. GLSL only.
#include "frame/uniforms.glsl"
#include "epipolar/grid.glsl"

layout(std140, binding = k_space_block) uniform EpipolarUniform { EpipolarBlock space; };
