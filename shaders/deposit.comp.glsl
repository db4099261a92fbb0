// One pixel of a slab: its echo into the bins of the beams that own its column, in 64-bit fixed point.
#include "interface.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D surface;
layout(std430, binding = SHARES_BINDING) readonly buffer Shares { ShareRecord shares[]; };
layout(std430, binding = SHARE_STARTS_BINDING) readonly buffer ShareStarts { uint share_starts[]; };
layout(std430, binding = EDGES_BINDING) readonly buffer Edges { double edges[]; };
layout(std430, binding = SUMS_BINDING) buffer Sums { uvec2 sums[]; };  // low and high word

uniform ivec2 image_size;
uniform bool shares_per_row;
uniform uint bin_count;
uniform double tan_elevation, bin_width, attenuation;
uniform dvec2 extent, pixel_size;

double binEdge(uint k) { return edges[k]; }

// The order of additions does not matter: words are integers, and every wrap of the low word carries once.
void addFixed(uint cell, double amount) {
    double quanta = floor(min(amount, 1048576.0) * 1099511627776.0 + 0.5);
    uint high = uint(quanta / 4294967296.0);
    uint low = uint(quanta - double(high) * 4294967296.0);
    uint before = atomicAdd(sums[cell].x, low);
    high += uint(before + low < before);
    if (high != 0u) atomicAdd(sums[cell].y, high);
}

void addToBin(uint beam, uint bin, double amount, double weight) {
#ifdef HAVE_CERQUEIRA2017
    uint cell = 2u * (beam * bin_count + bin);
    addFixed(cell + 1u, weight);
#else
    uint cell = beam * bin_count + bin;
#endif
    addFixed(cell, amount);
}

#include "footprint.glsl"
#include "deposit.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, image_size))) return;
    vec4 texel = texelFetch(surface, pixel, 0);
    if (!(texel.x > 0.0) || isinf(texel.x)) return;
    dvec2 uv = (dvec2(pixel) + 0.5) * pixel_size - extent;
    double scale = 1.0 / (pixel_size.x * pixel_size.y);
    uint at = uint((shares_per_row ? pixel.y * image_size.x : 0) + pixel.x);
    for (uint i = share_starts[at]; i < share_starts[at + 1u]; ++i) {
        ShareRecord share = shares[i];
        Footprint cell = cellFootprint(uv.x, uv.y, share.u_low, share.u_high, pixel_size.y, tan_elevation, texel.x, texel.y, texel.z);
        if (cell.solid_angle > 0.0) depositCell(cell, share.beam, texel.x, texel.w, scale);
    }
}
