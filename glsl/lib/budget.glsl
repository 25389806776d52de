// The driver that ends loops; nothing else names it.
//
// lavapipe (Mesa's llvmpipe) ends every loop of an invocation after 65535 turns in sum, over all its loops and all lanes
// that run in step, without a word. So loops that may be long are written with the macros below: they end by themselves
// while the budget lasts, in a state from which another round can go on (resume.glsl). On other drivers it has no end.

// [turn] What the lanes that run in step with this one had left when they last settled.
uint loop_budget = LOOP_BUDGET;
// [turn] What this lane has made since. The turn that finds a loop's end counts too.
uint unpaid_turns = 0u;

bool budget_lasts() { return unpaid_turns < loop_budget; }

// The lanes pay for the turn that they end here and for the one of them that has spent most: the others have waited for it.
void settle() {
    loop_budget = subgroupMin(loop_budget - min(unpaid_turns + 1u, loop_budget));
    unpaid_turns = 0u;
}

// Pays for a loop of `outer` turns, each of which has a loop of `inner` turns. Both may differ from lane to lane.
void spend_nested(uint outer, uint inner) { unpaid_turns += subgroupMax(outer) * (subgroupMax(inner) + 1u) + 1u; }

// `while (condition)` without further loops in it. A search ends at what it has found and leaves it to the loop around it to
// go on: lavapipe loses what a lane stores in a loop that other lanes have not left yet.
#define SEARCH_WHILE(condition) for (++unpaid_turns; (condition) && budget_lasts(); ++unpaid_turns)

// `while (condition)` around searches.
#define REPEAT_WHILE(condition) for (++unpaid_turns; (condition) && budget_lasts(); settle())

// As `REPEAT_WHILE`, but what is `pending` is seen to in any case, for no round could go on with it.
#define REPEAT_WHILE_PENDING(pending, condition) \
    for (++unpaid_turns; (condition) && ((pending) || budget_lasts()); settle())

// `while (condition)` that is never left early, for it is short.
#define FINISH_WHILE(condition) for (++unpaid_turns; condition; ++unpaid_turns)
