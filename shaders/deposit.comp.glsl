// One pixel of a frustum: its echo into the bins of the beams that own its column, in 64-bit fixed point.
#include "interface.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform usampler2D picture;
layout(std430, binding = OBJECTS_BINDING) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, binding = COMMANDS_BINDING) readonly buffer Commands { CommandRecord commands[]; };
layout(std430, binding = PLANES_BINDING) readonly buffer Planes { PlaneRecord planes[]; };
layout(std430, binding = MATERIALS_BINDING) readonly buffer Materials { MaterialRecord materials[]; };
layout(std430, binding = SHARES_BINDING) readonly buffer Shares { ShareRecord shares[]; };
layout(std430, binding = SHARE_STARTS_BINDING) readonly buffer ShareStarts { uint share_starts[]; };
layout(std430, binding = EDGES_BINDING) readonly buffer Edges { double edges[]; };
layout(std430, binding = SUMS_BINDING) buffer Sums { uvec2 sums[]; };  // low and high word

uniform ivec2 image_size;
uniform uint bin_count, beam_stride;
uniform double bin_width, attenuation, strength_scale;
uniform dvec2 extent, pixel_size, frustum_axis;

#ifdef HAVE_ELEVATION_PATTERN
layout(std430, binding = ELEVATION_BINDING) readonly buffer Elevation { double elevation_powers[]; };
uniform double elevation_reach;
double elevationPower(uint i) { return elevation_powers[i]; }
#include "elevation.glsl"
#endif

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
    uint cell = 2u * (beam * beam_stride + bin);
    addFixed(cell + 1u, weight);
#else
    uint cell = beam * beam_stride + bin;
#endif
    addFixed(cell, amount);
}

#include "jitter.glsl"
#include "surface.glsl"
#include "footprint.glsl"
#define real double
#include "trapezoid.glsl"
#include "deposit.glsl"

dvec3 slabFromSonar(dvec3 p) {
    return dvec3(frustum_axis.x * p.x + frustum_axis.y * p.y, frustum_axis.x * p.y - frustum_axis.y * p.x, p.z);
}

Surface surfaceOf(CommandRecord command, uint triangle, dvec2 uv) {
    ObjectRecord object = objects[command.object];
    PlaneRecord plane = planes[command.first_triangle + triangle];
    dvec3 across = dvec3(plane.normal.xyz);
    dvec3 normal = dvec3(dot(dvec3(object.normal_x.xyz), across), dot(dvec3(object.normal_y.xyz), across), dot(dvec3(object.normal_z.xyz), across));
    double distance = dot(across, dvec3(plane.point.xyz) - (dvec3(object.eye.xyz) + dvec3(object.eye_rest.xyz))) + double(plane.normal.w);
    normal = slabFromSonar(normal);
    return surfaceAt(normal.x, normal.y, normal.z, distance, uv.x, uv.y);
}

double strengthOf(uint material) {
#ifdef HAVE_CERQUEIRA2017
    return double(materials[material].values.y) * strength_scale;
#else
    return double(materials[material].values.x) * strength_scale;
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, image_size))) return;
    uvec4 texel = texelFetch(picture, pixel, 0);
    dvec2 uv = (dvec2(pixel) + 0.5) * pixel_size - extent;
    Surface surface = Surface(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    double strength = 0.0;
    dvec2 reach = dvec2(0.0);  // inverse ranges of the object
    if (texel.x != 0u) {
        CommandRecord command = commands[texel.x - 1u];
        dvec2 ray = uv;
#ifdef HAVE_JITTER
        ray += pixel_size * dvec2(jitter(pixel.x, pixel.y, 0u), jitter(pixel.x, pixel.y, 1u));
#endif
        surface = surfaceOf(command, texel.y, ray);
        double cosine = surface.cosine;
#ifdef HAVE_NORMAL_MAP
        if (texel.z != 0u) cosine = double(uintBitsToFloat(texel.z));
#endif
        strength = strengthOf(command.material) * cosine;
#ifdef HAVE_ELEVATION_PATTERN
        strength *= elevationWeight(uv.x, uv.y);
#endif
        reach = dvec2(objects[command.object].extent.xy);
    }
    double per_pixel = 1.0 / (pixel_size.x * pixel_size.y);
    uint at = uint(pixel.x);
#ifdef HAVE_CONICAL
    at += uint(pixel.y * image_size.x);  // the boundaries of beams bend from row to row
#endif
    for (uint i = share_starts[at]; i < share_starts[at + 1u]; ++i) {
        ShareRecord share = shares[i];
        Footprint cell = cellFootprint(uv.x, uv.y, share.middle, share.width, share.limit, share.shear, pixel_size.y,
                                       surface.inverse_range, surface.slope_u, surface.slope_v, surface.nearest, reach.x, reach.y,
                                       binEdge(0u), binEdge(bin_count), per_pixel);
        depositCell(cell, share.beam, strength * surface.range);
    }
}
