// Suspending an entry of a list and resuming it in the next round. In between, sums wait in the buffer `partial` and the
// place to go on at in the buffer `progress`. Sums go on where they stood and are never added to one another, so that an
// image does not depend on where rounds end.

#include "budget.glsl"
#include "rounds.glsl"

// The type of a sum; a technique may say otherwise first.
#ifndef SUM
#define SUM float
#endif

BUFFER(partial);
BUFFER(progress);

const Progress ENDED = Progress(FINISHED, 0u, 0u, 0u);

// Whether an earlier round has ended the entry whose progress is kept at `place`.
bool is_finished(uint place) { return !is_first_round() && progress[place].next == FINISHED; }

// Where this round goes on; all 0 in the first.
Progress resumed(uint place) {
    Progress from = Progress(0u, 0u, 0u, 0u);
    if (!is_first_round()) from = progress[place];
    return from;
}

// Keeps where the next round goes on; ENDED: nowhere.
void keep_progress(uint place, Progress next) {
    if (ROUNDS > 1u) progress[place] = next;
}
