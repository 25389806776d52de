#version 460
#extension GL_GOOGLE_include_directive : require
// A level of the hierarchy in 32-bit floats (hierarchy_build.glsl): bounds are exact.
#define BOUNDS_FORMAT rg32f

vec2 stored(vec2 bounds) { return bounds; }

#include "hierarchy_build.glsl"
