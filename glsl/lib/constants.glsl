// The specialization constants that passes share; a pass does not mind one that it does not read. What is read by one pass
// or by one technique stands there. Numbers are unique among all shaders.

layout(constant_id = 0) const uint PACKET_WIDTH = 1u;     // [pixel]
layout(constant_id = 1) const uint PACKET_HEIGHT = 1u;    // [pixel]
layout(constant_id = 3) const bool LANES = false;         // a packet's pixels have an invocation each
layout(constant_id = 5) const bool DISC_LIGHT = false;    // a disc's rim bounds the sub-light
layout(constant_id = 70) const uint EDGES = 0u;           // sides of a polygon that do
layout(constant_id = 6) const bool OBLIQUE = false;       // the map is not parallel to the light
layout(constant_id = 7) const bool COUNT = false;         // write `counters`
layout(constant_id = 8) const bool ACCUMULATE = false;    // what views add up is cleared before the first
layout(constant_id = 33) const bool WINDOWS = false;      // local packets form in windows, which the kernels list
layout(constant_id = 9) const bool TEXTURED = false;      // the scene has textures and texcoords
layout(constant_id = 11) const uint LOOP_BUDGET = 60000u; // [turn] of loops that the driver allows an invocation
layout(constant_id = 12) const uint ROUNDS = 1u;          // [dispatch] in which a list is worked off
layout(constant_id = 13) const uint LAYERS = 1u;          // peeled layers of the shadow map
layout(constant_id = 67) const uint VIEWS_AT_ONCE = 1u;   // [slot] for maps that are made side by side
layout(constant_id = 49) const uint QUALITY = 0u;         // which of a pixel's two levels of quality is added: a QUALITY_…
layout(constant_id = 80) const uint EVALUATE = 0u;        // [grid] the sparsest that pixels are joined on; 0: all are evaluated
layout(constant_id = 16) const bool CONTOURS = false;     // occluders are contours, not micropatches
