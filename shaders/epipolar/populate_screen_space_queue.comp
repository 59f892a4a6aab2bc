#version 450
#extension GL_GOOGLE_include_directive : require
#include "epipolar/populate_screen_space.glsl"
#include "epipolar/triangles_queued.glsl"
