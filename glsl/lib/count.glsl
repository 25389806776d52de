// 64-bit counters as two words, low and high.

#define COUNT_WIDE(counter, amount)                                         \
    {                                                                       \
        uint before = atomicAdd(counter.x, amount);                         \
        if (before + (amount) < before) atomicAdd(counter.y, 1u);           \
    }
