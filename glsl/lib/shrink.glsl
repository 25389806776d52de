// A kernel shrinks by repeated queries: what it holds bounds how near to the light its occluders are, and so where they can be
// [SS07; Yang09 alg. 1, step 5]. Needs hierarchy_layout.glsl.

// Queries that shrink a kernel; hardly any pixel takes as many.
const int ROUNDS_MAX = 8;

// [level] From the third query on, and where one has changed nothing, nodes are so much smaller: where they reach beyond the
// kernel, smaller ones do less so.
const int FINER = SPARSEST > 0u ? 1 : 0;
const int COARSE_ROUNDS = 2;

// Whether query number `round` leaves something to another. found: the greatest depth that it has found.
bool shrinks(float found, int round, inout float depth_max, inout int finer) {
    bool stalls = found >= depth_max;
    if (stalls && finer == FINER) return false;
    if (stalls || round >= COARSE_ROUNDS) finer = FINER;
    depth_max = min(depth_max, found);
    return true;
}
