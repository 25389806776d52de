// What a visibility pass counts for `--counters`.

BUFFER(counters);

// Of this invocation; never read, and so never kept, unless COUNT is set.
uint nodes_visited = 0u;
uint edges_extracted = 0u;
uint samples_read = 0u;

// 64-bit counters are two words, low and high.
#define COUNT_WIDE(counter, amount)                                         \
    {                                                                       \
        uint before = atomicAdd(counter.x, amount);                         \
        if (before + (amount) < before) atomicAdd(counter.y, 1u);           \
    }

void count_work() {
    COUNT_WIDE(counters.nodes_visited, nodes_visited)
    COUNT_WIDE(counters.edges_extracted, edges_extracted)
    COUNT_WIDE(counters.samples_read, samples_read)
}
