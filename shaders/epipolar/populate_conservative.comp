#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/populate_conservative.glsl"
#include "epipolar/triangles_few.glsl"
