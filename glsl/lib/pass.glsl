// What every pass begins with: shared structs, specialization constants, push constants.

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

#include "shared.glsl"
#include "constants.glsl"

// [turn] of all loops of the invocations that run in step with this one. lavapipe ends every loop after
// 65535 turns in sum (the one that finds the loop's end counts too), so long walks count theirs and say so when they could not finish.
uint steps = 0u;

layout(push_constant, scalar) uniform PushBlock { Push push; };
