#version 450
#extension GL_GOOGLE_include_directive : require
#define PRIVATE
#include "every_function.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer AllInputs { Inputs all_inputs[]; };
layout(std430, binding = 1) writeonly buffer AllOutputs { Outputs all_outputs[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(all_inputs.length())) return;
  call_every_function(all_inputs[i]);
  all_outputs[i] = outputs;
}
