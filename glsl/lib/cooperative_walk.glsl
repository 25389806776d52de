// A walk through the hierarchy that the lanes of a subgroup share: each looks at a node of its own, and what stays open goes back
// to a stack in shared memory, in the order of the lanes, so that a walk repeats to the bit. It finds the cells that
// hierarchical_contour.glsl finds. Any width of subgroup will do. Needs kernel.glsl, map.glsl, packet_bounds.glsl and
// budget.glsl.

#extension GL_KHR_shader_subgroup_ballot : require

#include "nodes.glsl"

// [node] Enough for a walk of twelve levels, of which each leaves three nodes for later, for any width from four on.
const uint STACK_PER_LANE = 16u;
// [cell] Twice what is wanted, less one.
const uint CELLS_PER_LANE = 2u;

// Those of each subgroup follow on one another.
shared uint stack[STACK_PER_LANE * GROUP_SIZE];
shared uint open_cells[CELLS_PER_LANE * GROUP_SIZE];

// [invocation] This one among its subgroup's, and how many take part.
uint lane;
uint lanes;
// Where the subgroup's part of shared arrays begins, for each element that a lane has of them.
uint share_first;

// The pass knows what else rules a node out, as in hierarchical_contour.glsl.
bool is_pruned(View view, Packet packet, ivec2 node, int side, vec2 bounds);

void find_lanes() {
    uvec4 all_lanes = subgroupBallot(true);
    uint share = GROUP_SIZE / gl_NumSubgroups;
    lane = subgroupBallotExclusiveBitCount(all_lanes);
    lanes = min(subgroupBallotBitCount(all_lanes), share);
    share_first = share * gl_SubgroupID;
}

uint packed_node(ivec2 cell, int level) { return uint(cell.x) | uint(cell.y) << 13 | uint(level) << 26; }

ivec2 cell_of(uint node) { return ivec2(node & 0x1fffu, node >> 13 & 0x1fffu); }

int level_of(uint node) { return int(node >> 26); }

struct SharedWalk {
    ivec2 first;
    ivec2 last;
    // Squares of four roots, which need not be nodes: where the first stands, how many there are, and those that are begun.
    ivec2 origin;
    uvec2 count;
    uint begun;
    // [level] Of these squares.
    int top;
    // [node] On the stack; their children are looked at next.
    uint size;
    // [cell] Found, and not yet seen to.
    uint found;
};

bool has_nodes(SharedWalk walk) { return walk.size > 0u || walk.begun < walk.count.x * walk.count.y; }

bool at_end(SharedWalk walk) { return !has_nodes(walk) && walk.found == 0u; }

// Over a packet's kernel, from nodes of the lowest level that is as large, as far as levels are built.
SharedWalk shared_walk_over(Packet packet, int level_count) {
    int level = root_level(packet, level_count);
    ivec2 first = unpacked(packet.first);
    ivec2 last = unpacked(packet.last);
    ivec2 origin = first_root(packet, level);
    uvec2 count = uvec2((last - origin) >> (level + 1)) + 1u;
    return SharedWalk(first, last, origin, count, 0u, level + 1, 0u, 0u);
}

// Puts the next squares of roots on the empty stack, one for each lane at most.
void begin_roots(inout SharedWalk walk) {
    uint added = min(walk.count.x * walk.count.y - walk.begun, lanes);
    uint root = walk.begun + lane;
    ivec2 place = ivec2(root % walk.count.x, root / walk.count.x) << walk.top;
    if (lane < added) stack[STACK_PER_LANE * share_first + lane] = packed_node(walk.origin + place, walk.top);
    walk.begun += added;
    walk.size = added;
    subgroupBarrier();
}

// Takes nodes from the stack and looks at their children, a lane at each.
void step_down(View view, Packet packet, inout SharedWalk walk) {
    if (walk.size == 0u) begin_roots(walk);
    // No more than leave room for what the deepest walk below them leaves for later.
    uint room = STACK_PER_LANE * lanes - walk.size;
    uint deepest = uint(walk.top);
    uint taken = min(min(walk.size, lanes / 4u), max(room / (3u * deepest), 1u));
    walk.size -= taken;
    bool open = lane < 4u * taken;
    uint parent = stack[STACK_PER_LANE * share_first + walk.size + (open ? lane / 4u : 0u)];
    subgroupBarrier();
    int level = level_of(parent) - 1;
    int side = 1 << level;
    ivec2 node = cell_of(parent) + ivec2(lane & 1u, lane >> 1 & 1u) * side;
    open = open && all(lessThanEqual(node, walk.last)) && all(greaterThan(node + side, walk.first));
    vec2 bounds = bounds_of(view, min(node, walk.last), level);
    nodes_visited += uint(open);
    samples_read += uint(open);
    open = open && may_differ(bounds, limits_in(packet, vec2(node), vec2(node + side)))
        && !is_pruned(view, packet, node, side, bounds);
    uvec4 parents = subgroupBallot(open && level > 0);
    uvec4 cells = subgroupBallot(open && level == 0);
    if (open && level > 0)
        stack[STACK_PER_LANE * share_first + walk.size + subgroupBallotExclusiveBitCount(parents)] = packed_node(node, level);
    if (open && level == 0)
        open_cells[CELLS_PER_LANE * share_first + walk.found + subgroupBallotExclusiveBitCount(cells)] = packed_node(node, 0);
    walk.size += subgroupBallotBitCount(parents);
    walk.found += subgroupBallotBitCount(cells);
    subgroupBarrier();
}

// Walks at least a step, and until there is a cell for each lane, or no node left. Gives each lane one of them; false: there is
// none for it.
bool next_cells(View view, Packet packet, inout SharedWalk walk, out ivec2 cell) {
    do {
        step_down(view, packet, walk);
        ++unpaid_turns;
    } while (has_nodes(walk) && walk.found < lanes && budget_lasts());
    uint taken = min(walk.found, lanes);
    walk.found -= taken;
    bool mine = lane < taken;
    cell = cell_of(open_cells[CELLS_PER_LANE * share_first + walk.found + (mine ? lane : 0u)]);
    subgroupBarrier();
    return mine;
}
