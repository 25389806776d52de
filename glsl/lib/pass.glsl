// What every pass begins with: shared structs, specialization constants, push constants, resources.

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_arithmetic : require

#include "shared.glsl"
#include "constants.glsl"
#include "resources.glsl"

layout(push_constant, scalar) uniform PushBlock { Push push; };

// Views whose maps are made side by side (plan/side_by_side.rs) have slots of their own: layers of the shadow map and of the hierarchy
// over it, parts of the list of casters. As many views in a row as there are slots have different ones.
uint slot_of(uint view) { return view % VIEWS_AT_ONCE; }
