// Hierarchical extraction of a packet's contour [Yang09 §4.2, alg. 3]: the hierarchy is walked from the nodes that cover the
// packet's kernel; a node is passed by where no sample can be an occluder to one of the packet's pixels and none to another
// (fig. 6, cases 4 and 5). It finds the edges that a scan of the kernel finds, in an order of its own. Needs what
// pixel_list.glsl and packet_list.glsl include.
//
// DEVIATION [Yang09 §4.2]: a large kernel starts from up to 4×4 roots instead of one (`ROOT_LEVELS`).

#include "nodes.glsl"
#include "walk.glsl"
#include "packet_bounds.glsl"

// The pass knows what else rules a node out: whether no edge in the `side` × `side` cells from `node` on, which have these
// bounds of depth, counts for the packet.
bool is_pruned(View view, Packet packet, ivec2 node, int side, vec2 bounds);

// The pass knows the corners of a cell that occlude, and whether they do for all of the packet's pixels [Yang09 eq. 3].
uint corners_in(Packet packet, ivec2 cell, vec4 depths, out bool agreed);

// A walk over the packet's kernel. Later rounds go on where the one before stood. It ends at the cells of the level of quality
// that is read [Yang09 §6].
Walk walk_over(Packet packet, uint level_count, Progress from) {
    int top = root_level(packet, int(level_count));
    Walk walk = walk_from(first_root(packet, top), top);
    if (!is_first_round()) walk = resumed_walk(from, top);
    return walk;
}

// Walks to the next cell with a contour and past it. False: there is none left.
bool next_cell(View view, Packet packet, inout Walk walk, inout ivec2 cell) {
    ivec2 first = unpacked(packet.first);
    ivec2 last = unpacked(packet.last);
    ivec2 root = first_root(packet, walk.top);
    bool found = false;
    SEARCH_WHILE(!found && !walk.ended) {
        int side = 1 << walk.level;
        vec2 bounds = bounds_of(view, min(walk.node, last), walk.level);
        vec4 limits = limits_in(packet, vec2(walk.node), vec2(walk.node + side));
        // Nodes stand where the level has them, not where the kernel begins and ends: some hang over.
        bool inside = all(lessThanEqual(walk.node, last)) && all(greaterThan(walk.node + side, first));
        bool open = inside && may_differ(bounds, limits) && !is_pruned(view, packet, walk.node, side, bounds);
        nodes_visited += uint(inside);
        samples_read += uint(inside);
        found = open && walk.level == 0;
        if (found) cell = walk.node;
        if (open && !found) descend(walk);
        else pass_by(walk, root, last);
    }
    return found;
}

// Where the extraction of edges stands: the walk, and the cell that it came to last.
struct Cursor {
    Walk walk;
    ivec2 cell;
    vec4 depths;
    uint mask;
    uint segment;
    // The cell has a second segment.
    bool more;
    // All pixels of the packet see the same contour in the cell.
    bool agreed;
};

Cursor cursor_at(Walk walk) { return Cursor(walk, ivec2(0), vec4(0.0), 0u, 0u, false, true); }

bool at_end(Cursor cursor) { return cursor.walk.ended && !cursor.more; }

// Goes on to the next edge. False: there is none left, or the packet's pixels disagree about it.
bool next_edge(View view, Packet packet, inout Cursor cursor) {
    cursor.segment = cursor.more ? 1u : 0u;
    bool found = cursor.more;
    if (!cursor.more) found = next_cell(view, packet, cursor.walk, cursor.cell);
    cursor.depths = depths_of(0u, cursor.cell);
    bool agreed;
    uint mask = corners_in(packet, cursor.cell, cursor.depths, agreed);
    cursor.mask = found ? mask : 0u;
    cursor.agreed = agreed || !found;
    uint segments = cursor.agreed ? segment_count(cursor.mask) : 0u;
    cursor.more = cursor.segment + 1u < segments;
    samples_read += found ? 4u : 0u;
    return cursor.segment < segments;
}

Edge edge_at(Cursor cursor) { return edge_of(cursor.cell, cursor.depths, cursor.mask, cursor.segment); }
