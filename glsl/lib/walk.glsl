// A walk through a quadtree below one root after the other, depth first, with the stack of [DU07] as [Yang09 alg. 3] has it:
// a node is either descended into or passed by. Needs kernel.glsl.

// The stack is one integer: two bits for each level between the root and the current node, which say which
// child it is.
struct Walk {
    ivec2 root;
    ivec2 node;
    int top;
    int level;
    uint stack;
    bool ended;
};

// Over the cells from `first` on, with roots of level `top`.
Walk walk_from(ivec2 first, int top) { return Walk(first, first, top, top, 0u, false); }

void descend(inout Walk walk) {
    --walk.level;
    walk.stack <<= 2;
}

// Goes on to the next node that is not below this one. first, last: the cells to be covered.
void pass_by(inout Walk walk, ivec2 first, ivec2 last) {
    // Up to the nearest ancestor that is not its parent's last child.
    int pops = min(findLSB(~walk.stack) >> 1, walk.top - walk.level);
    walk.node -= ivec2(((1 << pops) - 1) << walk.level);
    walk.level += pops;
    walk.stack = (walk.stack >> (2 * pops)) + 1u;
    // Children 0 … 3 stand at (0, 0), (1, 0), (0, 1), (1, 1).
    int side = 1 << walk.level;
    walk.node += (walk.stack & 1u) != 0u ? ivec2(side, 0) : ivec2(-side, side);
    if (walk.level == walk.top) {
        walk.root.x += side;
        if (walk.root.x > last.x) walk.root = ivec2(first.x, walk.root.y + side);
        walk.node = walk.root;
        walk.stack = 0u;
        walk.ended = walk.root.y > last.y;
    }
}

// Where the next round goes on with a walk.
Progress progress_of(Walk walk) {
    return Progress(walk.ended ? FINISHED : packed(walk.node), packed(walk.root), uint(walk.level), walk.stack);
}

// A walk with roots of level `top` that goes on where it stood.
Walk resumed_walk(Progress at, int top) {
    return Walk(unpacked(at.root), unpacked(at.next), top, int(at.level), at.stack, at.next == FINISHED);
}
