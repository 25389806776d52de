// Lists are worked off in up to ROUNDS dispatches (budget.glsl says why there may be more than one). `push.level` is the
// round; each reaches only as far as there is something left to do for it.

BUFFER(rounds);

bool is_first_round() { return push.level == 0u; }

bool is_last_round() { return push.level + 1u == ROUNDS; }

// Makes a dispatch, which is over as many views as this one, reach work group `group`.
#define REACH(groups, group)                                                \
    {                                                                       \
        atomicMax(groups.x, min((group) + 1u, GROUPS_PER_ROW));             \
        atomicMax(groups.y, (group) / GROUPS_PER_ROW + 1u);                 \
        atomicMax(groups.z, gl_NumWorkGroups.z);                            \
    }

// Makes round `i` of packet lists reach a work group.
void reach_packets(uint i, uint group) { REACH(rounds[push.index * ROUNDS + i].packet_groups, group) }

// Makes round `i` of pixel lists reach a work group.
void reach_pixels(uint i, uint group) { REACH(rounds[push.index * ROUNDS + i].pixel_groups, group) }
