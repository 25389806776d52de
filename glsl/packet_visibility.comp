#version 460
#extension GL_GOOGLE_include_directive : require
// Visibility of coherent packets of w×h pixels [Yang09 §4.1, alg. 1, step 7]: each edge of the contour in the packet's
// extended kernel is extracted once (alg. 3, hierarchical_contour.glsl) and integrated for each of its pixels (alg. 2,
// `sum_kernel` below). Where the pixels see different contours, each gets its own edges, or all of the packet goes to the
// pixel list; so the image is that of pixel_visibility.comp.
#include "pass.glsl"
#include "side_by_side.glsl"
#include "packet_list.glsl"
#include "hierarchical_contour.glsl"

layout(constant_id = 2) const bool REPROCESS = false;  // what a packet's pixels disagree about sends them to the pixel list

// [edge] Edges are integrated in batches, so that what is kept of a pixel is fetched once for all of a batch.
const uint BATCH = 4u;

bool is_pruned(View view, Packet packet, ivec2 node, int side, vec2 bounds) {
    return FOOTPRINT && !OBLIQUE && misses_light(view, packet, kappa, node, side, bounds.y);
}

// `classify` sends them to the pixel list.
bool is_behind(Packet packet) { return false; }

uint corners_in(Packet packet, ivec2 cell, vec4 depths, out bool agreed) { return mask_in(packet, cell, depths, agreed); }

// Extracts edges until the batch is full, the walk ends, or the pixels disagree about a cell's contour; that cell is left to
// the caller. Returns the number of edges.
uint extract_edges(View view, Packet packet, inout Cursor cursor, inout Edge batch[BATCH]) {
    uint count = 0u;
    cursor.agreed = true;
    REPEAT_WHILE_PENDING(cursor.more, count < BATCH && cursor.agreed && !at_end(cursor)) {
        bool found = next_edge(view, packet, cursor);
        Edge edge = edge_at(cursor);
        [[unroll]] for (uint i = 0u; i < BATCH; ++i) {
            bool here = i == count;
            batch[i].a = here ? edge.a : batch[i].a;
            batch[i].b = here ? edge.b : batch[i].b;
        }
        count += uint(found);
    }
    edges_extracted += count;
    return count;
}

// Back-projects and integrates a batch of edges for each pixel.
void integrate(View view, Edge batch[BATCH], uint count) {
    for (uint slot = 0u; slot < slot_end && count > 0u; ++slot) {
        Receiver receiver = receiver_of(slot);
        // One by one, so that the sum does not depend on where batches and rounds end; not unrolled, for most of what
        // drivers compile is in here.
        float area = sum[slot];
        [[dont_unroll]] for (uint i = 0u; i < count; ++i) {
            Edge edge = batch[0];
            [[unroll]] for (uint j = 1u; j < BATCH; ++j) {
                edge.a = i == j ? batch[j].a : edge.a;
                edge.b = i == j ? batch[j].b : edge.b;
            }
            area -= edge_beyond(view, receiver, edge);
        }
        sum[slot] = area;
    }
    spend_nested(slot_end, count);
}

// A cell whose contour the pixels disagree about: each has its own [algorithm.md §6, `per-pixel`].
void integrate_apart(View view, Cursor cursor) {
    bool more = !cursor.agreed;
    for (uint segment = 0u; more; ++segment) {
        more = false;
        for (uint slot = 0u; slot < slot_end; ++slot) {
            Receiver receiver = receiver_of(slot);
            uint mask = occluding(receiver, cursor.cell, cursor.depths);
            sum[slot] -= segment_beyond(view, receiver, cursor.cell, cursor.depths, mask, segment);
            edges_extracted += uint(is_kept[slot] && segment < segment_count(mask));
            more = more || segment + 1u < segment_count(mask);
        }
    }
    // Hardly ever two segments; counted as if always.
    spend_nested(cursor.agreed ? 0u : 2u, SLOTS);
}

// For each edge of the kernel's contour, for each pixel [Yang09 alg. 2]. The loops are nested so that invocations side by side
// walk together and integrate together.
Progress sum_kernel(View view, Packet packet, Progress from, out bool agreed) {
    Edge batch[BATCH];
    [[unroll]] for (uint i = 0u; i < BATCH; ++i) batch[i] = Edge(vec3(0.0), vec3(0.0));
    Cursor cursor = cursor_at(walk_over(packet, fits[view_index()].level_count, from));
    REPEAT_WHILE_PENDING(cursor.more, !at_end(cursor) && (cursor.agreed || !REPROCESS)) {
        uint count = extract_edges(view, packet, cursor, batch);
        integrate(view, batch, count);
        if (!REPROCESS) integrate_apart(view, cursor);
    }
    agreed = cursor.agreed || !REPROCESS;
    return progress_of(cursor.walk);
}
