// The visible surface at each of a pixel's samples, where pictures are anti-aliased: as the g-buffer has it, in images of as many
// samples. All samples of a triangle in a pixel have
// one position, in their middle.

const int SAMPLES = 4;

layout(binding = 57) uniform texture2DMS position_samples;
layout(binding = 58) uniform texture2DMS normal_samples;
layout(binding = 59) uniform texture2DMS albedo_samples;
