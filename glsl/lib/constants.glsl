// The specialization constants of all passes. A pass that does not use one does not mind.

layout(constant_id = 0) const uint PACKET_WIDTH = 1u;   // [pixel]
layout(constant_id = 1) const uint PACKET_HEIGHT = 1u;  // [pixel]
layout(constant_id = 2) const bool REPROCESS = false;   // leaf rule: null status → pixel-wise list
layout(constant_id = 3) const bool LANES = false;       // mapping: one invocation per pixel
layout(constant_id = 4) const bool FOOTPRINT = true;    // prune nodes that miss the light
layout(constant_id = 5) const bool ROUND = false;       // the sub-light is a disc or cut by one
layout(constant_id = 6) const bool OBLIQUE = false;     // the map is not parallel to the light
layout(constant_id = 7) const bool COUNT = false;       // write `counters`
layout(constant_id = 8) const bool ACCUMULATE = false;  // the light has more than one view
layout(constant_id = 9) const bool TEXTURED = false;    // the scene has textures and texcoords
layout(constant_id = 10) const uint HELD = 1u;          // [pixel] integrated by one invocation
layout(constant_id = 11) const uint STEPS_MAX = 60000u; // turns of loops that the driver allows an invocation
