// Where a view's casters stand in the list of indices: in its slot as many as the scene has, opaque ones first.

uint first_opaque_index(uint view) { return 3u * slot_of(view) * (frame.opaque_count + frame.masked_count); }

uint first_masked_index(uint view) { return first_opaque_index(view) + 3u * frame.opaque_count; }
