// One pixel of a frustum: its echo into the bins of the beams that own its column, in 64-bit fixed point.
#include "interface.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform usampler2D picture;
layout(std430, binding = OBJECTS_BINDING) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, binding = COMMANDS_BINDING) readonly buffer Commands { CommandRecord commands[]; };
layout(std430, binding = PLANES_BINDING) readonly buffer Planes { vec4 planes[]; };  // PlaneRecords, then FacetRecords
layout(std430, binding = MATERIALS_BINDING) readonly buffer Materials { MaterialRecord materials[]; };
layout(std430, binding = SHARES_BINDING) readonly buffer Shares { ShareRecord shares[]; };
layout(std430, binding = SHARE_STARTS_BINDING) readonly buffer ShareStarts { uint share_starts[]; };
layout(std430, binding = NUMBERS_BINDING) readonly buffer Numbers { double numbers[]; };  // edges of the bins, then tables
layout(std430, binding = SUMS_BINDING) buffer Sums { uvec2 sums[]; };  // low and high word

uniform ivec2 image_size;
uniform uint bin_count, beam_stride;
uniform double bin_width, attenuation, strength_scale;
uniform dvec2 extent, pixel_size, frustum_axis;

#ifdef HAVE_ELEVATION_PATTERN
uniform double elevation_reach;
uniform uint first_elevation;  // among the numbers
double elevationPower(uint i) { return numbers[first_elevation + i]; }
#include "elevation.glsl"
#endif
#ifdef HAVE_BACKSCATTER_LAWS
uniform uint first_backscatter;  // among the numbers
uniform uint first_facet;        // among the vectors of the planes
FacetRecord facetOf(uint triangle) {
    uint at = first_facet + 3u * triangle;
    return FacetRecord(planes[at], planes[at + 1u], planes[at + 2u]);
}
double backscatterEntry(uint i) { return numbers[first_backscatter + i]; }
#include "backscatter.glsl"
#endif

double binEdge(uint k) { return numbers[k]; }

#ifdef HAVE_CERQUEIRA2017
const uint channels = 2u;
#else
const uint channels = 1u;
#endif

#ifdef HAVE_VOLUME
uint cellOf(uint beam, uint bin, uint channel) { return 2u * beam * beam_stride + bin; }  // the volume comes after it
#else
uint cellOf(uint beam, uint bin, uint channel) { return channels * (beam * beam_stride + bin) + channel; }
#endif

// Low and high word of an amount in quanta.
uvec2 quantaOf(double amount) {
    double quanta = floor(min(amount, 1048576.0) * 1099511627776.0 + 0.5);
    uint high = uint(quanta / 4294967296.0);
    return uvec2(uint(quanta - double(high) * 4294967296.0), high);
}

// The order of additions does not matter: words are integers, and every wrap of the low word carries once.
void addToMemory(uint cell, uvec2 quanta) {
    uint before = atomicAdd(sums[cell].x, quanta.x);
    uint high = quanta.y + uint(before + quanta.x < before);
    if (high != 0u) atomicAdd(sums[cell].y, high);
}

// The pixels of a group lie in few beams and, as a rule, in a narrow span of bins. What lies there is summed in the group's
// own memory, and each of its sums is brought out once.
const uint group_beams = 8u, group_bins = 32u, group_cells = group_beams * group_bins * channels;
shared uint first_beam, first_bin;
shared uint group_low[group_cells], group_high[group_cells];

void add(uint beam, uint bin, uint channel, double amount) {
    uvec2 quanta = quantaOf(amount);
    uint row = beam - first_beam, column = bin - first_bin;  // of what comes before these, far beyond the span
    if (row >= group_beams || column >= group_bins) {
        addToMemory(cellOf(beam, bin, channel), quanta);
        return;
    }
    uint cell = channels * (row * group_bins + column) + channel;
    uint before = atomicAdd(group_low[cell], quanta.x);
    uint high = quanta.y + uint(before + quanta.x < before);
    if (high != 0u) atomicAdd(group_high[cell], high);
}

// Called by all of a group, each with the first beam and bin of its echo; bin_count: it has none.
void beginGroup(uint beam, uint bin) {
    for (uint i = gl_LocalInvocationIndex; i < group_cells; i += 64u) group_low[i] = group_high[i] = 0u;
    if (gl_LocalInvocationIndex == 0u) first_beam = first_bin = 0xffffffffu;
    barrier();
    if (bin < bin_count) {
        atomicMin(first_beam, beam);
        atomicMin(first_bin, bin);
    }
    barrier();
}

void endGroup() {
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < group_cells; i += 64u) {
        uint beam = first_beam + i / (channels * group_bins), bin = first_bin + i / channels % group_bins;
        uvec2 quanta = uvec2(group_low[i], group_high[i]);
        if (quanta != uvec2(0u)) addToMemory(cellOf(beam, bin, i % channels), quanta);
    }
}

void addToBin(uint beam, uint bin, double amount, double weight) {
    add(beam, bin, 0u, amount);
#ifdef HAVE_CERQUEIRA2017
    add(beam, bin, 1u, weight);
#endif
}

#include "jitter.glsl"
#include "footprint.glsl"
#include "plane.glsl"
#include "picture.glsl"
#define real double
#include "trapezoid.glsl"
#include "deposit.glsl"

#ifdef HAVE_VOLUME
void addVolume(uint beam, uint bin, double amount) {
    uvec2 quanta = quantaOf(abs(amount));
    if (amount < 0.0) quanta = uvec2(~quanta.x + 1u, ~quanta.y + uint(quanta.x == 0u));
    addToMemory((2u * beam + 1u) * beam_stride + bin, quanta);
}
#ifdef HAVE_VOLUME_LAYERS
uniform uint layer_count, first_layer;
uniform double sonar_height;
uniform dvec3 upward;
double layerNumber(uint i) { return numbers[first_layer + i]; }
#endif
#include "volume.glsl"

void depositVolume(Footprint cell, uint beam, dvec2 uv) {
#ifdef HAVE_VOLUME_LAYERS
    double rise = dot(upward, dvec3(1.0, uv)) / sqrt(1.0 + dot(uv, uv));
    if (cell.pixel > 0.0)
        hideVolume(cell, beam, rise, cell.size);
    else
        hearLayers(beam, rise, double(bin_count) * bin_width, cell.size);
#else
    if (cell.pixel > 0.0) hideVolume(cell, beam, 0.0, cell.size);
#endif
}
#endif

dvec3 frustumFromSonar(dvec3 p) {
    return dvec3(frustum_axis.x * p.x + frustum_axis.y * p.y, frustum_axis.x * p.y - frustum_axis.y * p.x, p.z);
}

double strengthOf(uint material) {
#ifdef HAVE_CERQUEIRA2017
    return double(materials[material].values.y) * strength_scale;
#else
    return double(materials[material].values.x) * strength_scale;
#endif
}

// What a pixel shows: its triangle's plane in the frustum's axes, and what belongs to its material and object.
struct Seen {
    dvec3 normal;
    double distance;
    dvec2 ray;        // where the pixel is looked at
    double strength;  // at normal incidence
    double mapped;    // cosine of a bent normal; 0: it is the plane's
    dvec2 reach;      // inverse ranges of the object [1/m]
    double weight;    // of the pattern in elevation [1]
    uint material, triangle;
    dvec3 axis;  // of the facet's lobe
};

// A normal, or what is turned as normals are, in the frustum's axes.
dvec3 placed(ObjectRecord object, dvec3 normal) {
    return frustumFromSonar(dvec3(dot(dvec3(object.normal_x.xyz), normal), dot(dvec3(object.normal_y.xyz), normal), dot(dvec3(object.normal_z.xyz), normal)));
}

Seen seenAt(ivec2 pixel, dvec2 uv) {
    Seen seen = Seen(dvec3(1.0, 0.0, 0.0), 0.0, uv, 0.0, 0.0, dvec2(0.0), 1.0, 0u, 0u, dvec3(0.0));
#ifdef HAVE_ELEVATION_PATTERN
    seen.weight = elevationWeight(uv.x, uv.y);
#endif
    uvec4 texel = texelFetch(picture, pixel, 0);
    if (texel.x == 0u) return seen;
    CommandRecord command = commands[texel.x - 1u];
    ObjectRecord object = objects[command.object];
    seen.triangle = command.first_triangle + texel.y;
    PlaneRecord plane = PlaneRecord(planes[2u * seen.triangle], planes[2u * seen.triangle + 1u]);
    dvec3 across = dvec3(plane.normal.xyz);
    seen.normal = placed(object, across);
    seen.distance = dot(across, dvec3(plane.point.xyz) - (dvec3(object.eye.xyz) + dvec3(object.eye_rest.xyz))) + double(plane.normal.w);
#ifdef HAVE_JITTER
    seen.ray += pixel_size * dvec2(jitter(pixel.x, pixel.y, 0u), jitter(pixel.x, pixel.y, 1u));
#endif
    seen.strength = strengthOf(command.material);
#ifdef HAVE_NORMAL_MAP
    if (texel.z != 0u) seen.mapped = double(uintBitsToFloat(texel.z));
#endif
    seen.reach = dvec2(object.extent.xy);
    seen.material = command.material;
#ifdef HAVE_BACKSCATTER_LAWS
    if (materials[seen.material].law.y > 0.0) seen.axis = placed(object, dvec3(facetOf(seen.triangle).axis.xyz));
#endif
    return seen;
}

// Where in share_starts a pixel's shares begin and end.
uint sharesOf(ivec2 pixel) {
#ifdef HAVE_CONICAL
    return uint(pixel.x + pixel.y * image_size.x);  // the boundaries of beams bend from row to row
#else
    return uint(pixel.x);
#endif
}

// Strength times slant range of a cell that is looked at along `towards` [m].
double strengthRange(Seen seen, PlaneFootprint cell, dvec2 towards, double width, double height) {
    double inverse_range = cell.footprint.pixel;
    bool mapped = seen.mapped > 0.0 && cell.perpendicular > 0.0;
#ifdef HAVE_BACKSCATTER_LAWS
    MaterialRecord material = materials[seen.material];
    if (!FOLLOWS_LAMBERT(material.law) && inverse_range > 0.0) {
        double cosine = mapped ? seen.mapped : min(cell.perpendicular * inverse_range, 1.0);
        LobeSlopes slopes = LobeSlopes(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        if (material.law.y > 0.0) {
            double level = sqrt(1.0 + towards.x * towards.x), per_length = 1.0 / sqrt(1.0 + dot(towards, towards));
            slopes = lobeSlopes(facetOf(seen.triangle), double(material.law.z), 1.0 / inverse_range, seen.normal.x, seen.normal.y,
                                seen.normal.z, seen.axis.x, seen.axis.y, seen.axis.z, 1.0 / level, towards.x / level,
                                level * per_length, towards.y * per_length, width, height, seen.mapped);
        }
        return strength_scale / inverse_range * backscatterOverCosine(material.law, double(material.values.x), cosine, slopes);
    }
#endif
    return seen.strength * (mapped ? seen.mapped / inverse_range : cell.perpendicular);
}

double facingOf(dvec3 normal, dvec2 uv) { return dot(normal, dvec3(1.0, uv)) / sqrt(1.0 + dot(uv, uv)); }

void depositShare(ShareRecord share, dvec2 uv, Seen seen) {
    PictureCell at = pictureCell(uv.x, uv.y, share.middle, share.width, share.limit, share.shear, pixel_size.y,
                                 1.0 / (pixel_size.x * pixel_size.y));
#if defined(HAVE_NEAREST) || defined(HAVE_PUBLISHED)
    dvec2 towards = seen.ray;
#else
    dvec2 towards = dvec2(at.u, at.v);
    double of_ray = facingOf(seen.normal, uv), of_cell = facingOf(seen.normal, towards);
    if (of_ray * of_cell > 0.0) seen.mapped *= of_cell / of_ray;
#endif
    double level = sqrt(1.0 + towards.x * towards.x), per_length = 1.0 / sqrt(1.0 + dot(towards, towards));
    PlaneFootprint cell = planeFootprint(seen.normal.x, seen.normal.y, seen.normal.z, seen.distance, 1.0 / level,
                                         towards.x / level, level * per_length, towards.y * per_length, at.width,
                                         at.height, 0.0, at.size * seen.weight, seen.reach.x, seen.reach.y,
                                         binEdge(0u), binEdge(bin_count));
    depositCell(cell.footprint, share.beam, strengthRange(seen, cell, towards, at.width, at.height));
#ifdef HAVE_VOLUME
    cell.footprint.size = at.size * seen.weight;
    depositVolume(cell.footprint, share.beam, towards);
#endif
}

void depositPixel(ivec2 pixel, dvec2 uv, Seen seen) {
    uint at = sharesOf(pixel);
    for (uint i = share_starts[at]; i < share_starts[at + 1u]; ++i) depositShare(shares[i], uv, seen);
}

// The bin in which a pixel's echo lies, nearly; bin_count: there is none.
uint firstBin(Seen seen) {
    double inverse_range = seen.distance != 0.0 ? facingOf(seen.normal, seen.ray) / seen.distance : 0.0;
    return inverse_range > 0.0 ? uint(min(1.0 / (inverse_range * bin_width), double(bin_count))) : bin_count;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool inside = all(lessThan(pixel, image_size));
    dvec2 uv = (dvec2(pixel) + 0.5) * pixel_size - extent;
    Seen seen = seenAt(min(pixel, image_size - 1), uv);
    uint at = sharesOf(min(pixel, image_size - 1)), share = share_starts[at];
    bool heard = inside && share < share_starts[at + 1u];
    beginGroup(heard ? shares[share].beam : 0u, heard ? firstBin(seen) : bin_count);
    if (inside) depositPixel(pixel, uv, seen);
    endGroup();
}
