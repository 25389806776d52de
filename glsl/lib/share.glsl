// The share that a part has of a whole, 0 to 1: exactly 1 for all of it, though a device's x / x need not be 1.
float share_of(float part, float whole) { return part < whole ? clamp(part / whole, 0.0, 1.0) : 1.0; }
