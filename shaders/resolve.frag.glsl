// Writes the four samples of each pixel as four pixels, each in its quarter.
layout(binding = 0) uniform usampler2DMS samples;
uniform ivec4 sample_of_quarter;  // left below, right below, left above, right above

layout(location = 0) out uvec4 surface;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    surface = texelFetch(samples, at / 2, sample_of_quarter[(at.x & 1) + 2 * (at.y & 1)]);
}
