#version 450
#extension GL_GOOGLE_include_directive : require
#include "media/medium_ray.glsl"
#include "surface_shadows/metric_tree_walk.glsl"
#include "media/tree_march.glsl"
