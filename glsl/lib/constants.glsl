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
layout(constant_id = 12) const uint ROUNDS = 1u;        // [dispatch] in which a list is worked off
layout(constant_id = 13) const uint LAYERS = 1u;          // peeled layers of the shadow map
layout(constant_id = 14) const bool PEEL = false;         // draw what lies behind the last layer
layout(constant_id = 15) const bool GAP_FILLING = false;  // micropatches reach out to their neighbours
layout(constant_id = 16) const bool CONTOURS = false;     // occluders are contours, not micropatches
layout(constant_id = 17) const uint LIGHT_SAMPLES = 8u;   // a side of the bitmask
layout(constant_id = 18) const bool JITTERED = false;     // light samples stand anywhere in their strata
layout(constant_id = 19) const uint BLOCKER_SAMPLES = 1u; // of the blocker search
layout(constant_id = 20) const uint FILTER_SAMPLES = 1u;  // of the percentage-closer filter
layout(constant_id = 21) const int FILTER_REACH = 0;      // [texel] of the hard test's percentage-closer filter
layout(constant_id = 22) const bool MASKED = false;       // the casters drawn have holes
layout(constant_id = 23) const bool GIVEN = false;        // a host has the shadow maps already
layout(constant_id = 24) const bool POSITIONS = false;    // a host's surface is positions rather than depths
layout(constant_id = 25) const bool RESIDUALS = false;    // casters' positions have residuals
