#version 460
#extension GL_GOOGLE_include_directive : require
// A level of the hierarchy in 16-bit floats (hierarchy_build.glsl), half the bytes: bounds are conservative, by integer
// arithmetic, since drivers round differently when they store. What arrives is a 16-bit float already. Depths are in [0, 1],
// 0 = empty.
#define BOUNDS_FORMAT rg16f

// The bits of a 32-bit float that a normal 16-bit float has not, and the smallest such.
const uint DROPPED = 0x1fffu;
const float SMALLEST = 1.0 / 16384.0;

// The largest normal 16-bit float (or 0) that is not above the lower bound, and the smallest that is not below the upper.
vec2 stored(vec2 bounds) {
    float lower = bounds.x < SMALLEST ? 0.0 : uintBitsToFloat(floatBitsToUint(bounds.x) & ~DROPPED);
    float above = uintBitsToFloat((floatBitsToUint(bounds.y) + DROPPED) & ~DROPPED);
    return vec2(lower, bounds.y > 0.0 ? max(above, SMALLEST) : 0.0);
}

#include "hierarchy_build.glsl"
