// A driver may end all loops of an invocation after a number of turns (see `steps`). What is not finished by then goes
// on in the next round: a dispatch that reaches only as far as there is something left to do. In between, a pixel's
// sum waits in the buffer `partial` and the place to go on at in the buffer `progress`. `push.level` is the round.
// Needs the binding `rounds`: of each view, the dispatches of all rounds.

// Makes a dispatch reach work group `group`.
#define REACH(groups, group)                                                \
    {                                                                       \
        atomicMax(groups.x, min((group) + 1u, GROUPS_PER_ROW));             \
        atomicMax(groups.y, (group) / GROUPS_PER_ROW + 1u);                 \
        atomicMax(groups.z, 1u);                                            \
    }

// Place of one of the view's rounds in the buffer `rounds`.
uint at_round(uint round) { return push.index * ROUNDS + round; }

bool is_first_round() { return push.level == 0u; }

bool is_last_round() { return push.level + 1u == ROUNDS; }

bool out_of_turns(uint turns) { return steps + turns >= STEPS_MAX; }
