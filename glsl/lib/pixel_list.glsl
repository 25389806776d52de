// A technique over the pixel list: an invocation for each entry, which sums up over the pixel's kernel and in the end says
// what of the sub-light is hidden. The technique defines two functions, `sum_kernel` and `hidden_share`; the rest is here.

#include "receiver.glsl"
#include "kernel.glsl"
#include "contour.glsl"
#include "map.glsl"
#include "resume.glsl"
#include "count.glsl"
#include "blend.glsl"

layout(local_size_x = GROUP_SIZE) in;

readonly BUFFER(frame);
readonly BUFFER(views);
BUFFER(fits);
readonly BUFFER(kernels);
readonly BUFFER(lists);
readonly BUFFER(pixels);

#include "surface.glsl"
#include "part_of_view.glsl"
#include "occlusion.glsl"

// The pixel that this invocation works on, at the level of quality that the pass reads.
struct ListedPixel {
    uint index;
    View view;
    Receiver receiver;
    // [cell] Its kernel.
    ivec2 first;
    ivec2 last;
};

ListedPixel pixel;

// What the pixel adds up. A technique that adds up something else than one number defines SUM and SUM_WORDS first.
#ifndef SUM_WORDS
#define SUM_WORDS 1u
#endif
SUM sum[SUM_WORDS];

// Adds up over the pixel's kernel from `from` on (a `Progress` of the function's own making, or all 0 at the beginning), to
// the end or as far as the budget lasts, and returns where to go on: ENDED if there is nothing left.
Progress sum_kernel(Progress from);

// [0, 1] Share of the sub-light that is hidden, from a sum over all of the kernel.
float hidden_share();

ListedPixel listed_pixel(uint index) {
    View view = views[view_index()];
    choose_level(view, index);
    SurfacePoint point = surface_at(pixel_at(index));
    Receiver receiver = project(view, fits[view_index()], point.position - view.center, point.normal, point.error);
    Kernel kernel = kernels[first_pixel() + index];
    Cells cells = at_level(Cells(unpacked(kernel.first), unpacked(kernel.last), true));
    return ListedPixel(index, view, at_level(view, receiver), cells.first, cells.last);
}

// The pixel of a list's entry, which may be left to one of two levels of quality alone. False: nothing of it is this pass's.
bool is_for_pass(inout uint entry) {
    if (QUALITY == QUALITY_FINEST) return true;
    uint other = QUALITY == QUALITY_FINER ? LISTED_COARSER : LISTED_FINER;
    bool left_to_other = (entry & other) != 0u;
    entry &= ~(LISTED_FINER | LISTED_COARSER);
    return !left_to_other && share_of_level(entry) > 0.0;
}

void main() {
    uint group = gl_WorkGroupID.y * GROUPS_PER_ROW + gl_WorkGroupID.x;
    uint entry = group * GROUP_SIZE + gl_LocalInvocationID.x;
    if (entry >= lists[view_index()].pixel_count) return;
    uint place = first_pixel() + entry;
    uint listed = pixels[place];
    if (is_finished(place) || !is_for_pass(listed)) return;
    pixel = listed_pixel(listed);
    uint first_word = (first_pixel() + pixel.index) * SUM_WORDS;
    for (uint i = 0u; i < SUM_WORDS; ++i) sum[i] = is_first_round() ? SUM(0) : partial[first_word + i];

    Progress next = sum_kernel(resumed(place));

    bool complete = next.next == FINISHED;
    if (complete) {
        add_occluded(pixel.index, share_of_level(pixel.index) * pixel.view.weight * clamp(hidden_share(), 0.0, 1.0));
    } else if (!is_last_round()) {
        for (uint i = 0u; i < SUM_WORDS; ++i) partial[first_word + i] = sum[i];
        reach_pixels(push.level + 1u, group);
    } else {
        // There is no further round: the frame fails.
        atomicAdd(fits[view_index()].unfinished, 1u);
        next = ENDED;
    }
    keep_progress(place, next);
    if (COUNT) count_work();
}
