// Bounds reduced by atomicMax: integers in the order of the floats they stand for, never 0, so that 0 is "nothing yet". A
// lower bound is the upper bound of the negated value.

uint bound_of(float value) {
    uint bits = floatBitsToUint(value);
    return (bits >> 31) != 0u ? ~bits : bits | 0x80000000u;
}

// The float of a bound; `none` where nothing was reduced into it.
float value_of(uint bound, float none) {
    if (bound == 0u) return none;
    return uintBitsToFloat((bound >> 31) != 0u ? bound & 0x7fffffffu : ~bound);
}
