/* Creating and destroying again and again keeps no memory: CYCLES [device]. */
#include "check.h"

#include <malloc.h>

/* [KiB] Memory that is allocated and not freed, in all pools of the allocator. */
static long allocated(void) {
    struct mallinfo2 info = mallinfo2();
    return (long)((info.uordblks + info.hblkhd) / 1024);
}

/* [KiB] Resident memory. */
static long resident(void) {
    char line[256];
    long found = -1;
    FILE *file = fopen("/proc/self/status", "r");
    CHECK(file != NULL);
    while (fgets(line, sizeof line, file) != NULL) {
        if (strncmp(line, "VmRSS:", 6) == 0) found = atol(line + 6);
    }
    fclose(file);
    CHECK(found > 0);
    return found;
}

static void cycle(uint32_t flags) {
    hs_context *context = make_context(flags);
    hs_shot *shot = make_shot(context, 16, 0.4);
    /* Parents first, by turns: children keep them. */
    static int turn;
    if (++turn % 2 == 0) hs_context_destroy(context);
    hs_shot_destroy(shot);
    if (turn % 2 != 0) hs_context_destroy(context);
}

int main(int argc, char **argv) {
    long used, mapped;
    int i, cycles;
    uint32_t flags = argc > 2 && strcmp(argv[2], "device") == 0 ? 0 : HS_CONTEXT_WITHOUT_DEVICE;
    CHECK(argc > 1);
    cycles = atoi(argv[1]);
    /* What loaders and drivers keep for themselves they have by then. */
    for (i = 0; i < cycles; ++i) cycle(flags);
    used = allocated();
    mapped = resident();
    for (i = 0; i < cycles; ++i) cycle(flags);
    used = allocated() - used;
    mapped = resident() - mapped;
    printf("%d cycles: %ld KiB more in use, %ld KiB more resident\n", cycles, used, mapped);
    /* A leaked context or shot takes 1 KiB at least, so that a leak shows as a KiB a cycle. Without one, drivers keep
     * some 4 KiB of tables that grew. */
    CHECK(used < cycles / 2 + 10);
    /* What is mapped and not allocated (memory of a device, code) comes by 64 KiB and more. The allocator's pools
     * may grow by a MiB as threads come and go. */
    CHECK(mapped < 16 * cycles + 1024);
    return 0;
}
