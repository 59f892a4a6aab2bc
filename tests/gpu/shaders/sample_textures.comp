#version 450

// What samplers see at one place.
layout(local_size_x = 1) in;
layout(location = 0) uniform uvec4 place;  // x, y and z in sixteenths of the sides; level in halves
layout(binding = 0) uniform sampler2D image;
layout(binding = 1) uniform sampler2DArray layers;
layout(binding = 2) uniform sampler3D volume;
layout(std430, binding = 0) writeonly buffer Seen { vec4 seen[3]; };

void main() {
  vec3 at = vec3(place.xyz) / 16.0;
  float level = float(place.w) / 2.0;
  seen[0] = textureLod(image, at.xy, level);
  seen[1] = textureLod(layers, vec3(at.xy, 1.0), level);
  seen[2] = textureLod(volume, at, level);
}
