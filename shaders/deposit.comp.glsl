// One pixel of a frustum: adds its echo to the bins of the beams that own its column, in 64-bit fixed point. All
// numbers are in single precision, because many devices are 32 or 64 times slower in double. The place of an echo among
// the bins is exact nevertheless: inverse range is computed from picture and plane in pairs of floats, and the places
// of a cell are relative to the inverse range of its middle.
#include "interface.glsl"
#include "pair.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform usampler2D picture;
layout(std430, binding = OBJECTS_BINDING) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, binding = COMMANDS_BINDING) readonly buffer Commands { CommandRecord commands[]; };
layout(std430, binding = PLANES_BINDING) readonly buffer Planes { vec4 planes[]; };  // PlaneRecords, then FacetRecords
layout(std430, binding = MATERIALS_BINDING) readonly buffer Materials { MaterialRecord materials[]; };
layout(std430, binding = SHARES_BINDING) readonly buffer Shares { DeviceShare shares[]; };
layout(std430, binding = SHARE_STARTS_BINDING) readonly buffer ShareStarts { uint share_starts[]; };
layout(std430, binding = NUMBERS_BINDING) readonly buffer Numbers { float numbers[]; };  // edges of the bins, two floats each, then tables
layout(std430, binding = SUMS_BINDING) buffer Sums { uvec2 sums[]; };  // low and high word

uniform ivec2 image_size;
uniform uint bin_count, beam_stride;
uniform float bin_width, attenuation, strength_scale;
uniform vec2 extent_u, extent_v, pixel_u, pixel_v, axis_cosine, axis_sine;  // each the sum of two floats

#ifdef HAVE_ELEVATION_PATTERN
uniform float elevation_reach;
uniform uint first_elevation;  // among the numbers
float elevationPower(uint i) { return numbers[first_elevation + i]; }
#include "elevation.glsl"
#endif
#ifdef HAVE_BACKSCATTER_LAWS
uniform uint first_backscatter;  // among the numbers
uniform uint first_facet;        // among the vectors of the planes
FacetRecord readFacet(uint triangle) {
    uint at = first_facet + 3u * triangle;
    return FacetRecord(planes[at], planes[at + 1u], planes[at + 2u]);
}
float backscatterEntry(uint i) { return numbers[first_backscatter + i]; }
#include "backscatter.glsl"
#endif

Pair readPair(vec2 both) { return Pair(both.x, both.y); }

// The current cell: the inverse range to which its places are relative, and the place of its pixel's echo.
float origin = 0.0, pixel_place = 0.0;
float inverseRange(float place) { return origin + place; }

Pair getEdge(uint k) { return Pair(numbers[2u * k], numbers[2u * k + 1u]); }
float binEdge(uint k) { return beyond(getEdge(k), origin); }

// Returns the bin that contains a place in range. Edge 0 is the near blanking, which may be in any bin.
uint findBin(float place) {
    uint bin = min(uint(1.0 / (inverseRange(place) * bin_width)), bin_count - 1u);
    while (bin > 0u && binEdge(bin) < place) --bin;
    while (bin < bin_count - 1u && binEdge(bin + 1u) >= place) ++bin;
    return bin;
}

// Length of a part of a bin; exact for a whole bin, at any distance from the origin.
float computeLength(uint bin, float below, float above) {
    bool whole = below == binEdge(bin + 1u) && above == binEdge(bin);
    return whole ? computeSum(getEdge(bin), negative(getEdge(bin + 1u))).high : above - below;
}

#ifdef HAVE_CERQUEIRA2017
const uint channels = 2u;
#else
const uint channels = 1u;
#endif

#ifdef HAVE_VOLUME
uint findCell(uint beam, uint bin, uint channel) { return 2u * beam * beam_stride + bin; }  // the volume follows
#else
uint findCell(uint beam, uint bin, uint channel) { return channels * (beam * beam_stride + bin) + channel; }
#endif

// Low and high word of an amount in quanta of 2^-40.
uvec2 toQuanta(float amount) {
    float high = min(amount, 1048576.0) * 256.0, whole = floor(high);
    return uvec2(uint((high - whole) * 4294967296.0 + 0.5), uint(whole));
}

// The order of additions does not matter: words are integers, and every wrap of the low word carries once.
void addToMemory(uint cell, uvec2 quanta) {
    uint before = atomicAdd(sums[cell].x, quanta.x);
    uint high = quanta.y + uint(before + quanta.x < before);
    if (high != 0u) atomicAdd(sums[cell].y, high);
}

// The pixels of a group are in few beams and usually in a narrow span of bins. Their echoes are summed in the group's
// shared memory, and each sum is added to the buffer once.
const uint group_beams = 8u, group_bins = 32u, group_cells = group_beams * group_bins * channels;
shared uint first_beam, first_bin;
shared uint group_low[group_cells], group_high[group_cells];

void add(uint beam, uint bin, uint channel, float amount) {
    uvec2 quanta = toQuanta(amount);
    uint row = beam - first_beam, column = bin - first_bin;  // earlier beams and bins wrap to beyond the span
    if (row >= group_beams || column >= group_bins) {
        addToMemory(findCell(beam, bin, channel), quanta);
        return;
    }
    uint cell = channels * (row * group_bins + column) + channel;
    uint before = atomicAdd(group_low[cell], quanta.x);
    uint high = quanta.y + uint(before + quanta.x < before);
    if (high != 0u) atomicAdd(group_high[cell], high);
}

// Called by all invocations of a group, each with the first beam and bin of its echo; bin_count: no echo.
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
        if (quanta != uvec2(0u)) addToMemory(findCell(beam, bin, i % channels), quanta);
    }
}

void addToBin(uint beam, uint bin, float amount, float weight) {
    add(beam, bin, 0u, amount);
#ifdef HAVE_CERQUEIRA2017
    add(beam, bin, 1u, weight);
#endif
}

#include "jitter.glsl"
Pair makeJitter(ivec2 pixel, uint which) {  // jitter() with all 32 bits
    uint word = jitterWord(uint(pixel.x), uint(pixel.y), which);
    return exactSum(float(word >> 8u) * (1.0 / 16777216.0) - 0.5, float(word & 255u) * (1.0 / 4294967296.0));
}
#include "footprint.glsl"
#include "plane.glsl"
#include "picture.glsl"
#define real float
#include "trapezoid.glsl"
#include "deposit.glsl"

#ifdef HAVE_VOLUME
void addVolume(uint beam, uint bin, float amount) {
    uvec2 quanta = toQuanta(abs(amount));
    if (amount < 0.0) quanta = uvec2(~quanta.x + 1u, ~quanta.y + uint(quanta.x == 0u));
    addToMemory((2u * beam + 1u) * beam_stride + bin, quanta);
}
#ifdef HAVE_VOLUME_LAYERS
uniform uint layer_count, first_layer;
uniform float sonar_height;
uniform vec3 upward;
float layerNumber(uint i) { return numbers[first_layer + i]; }
#endif
#include "volume.glsl"

void depositVolume(Footprint cell, uint beam, vec2 uv) {
#ifdef HAVE_VOLUME_LAYERS
    float rise = dot(upward, vec3(1.0, uv)) / sqrt(1.0 + dot(uv, uv));
    if (cell.pixel > 0.0)
        hideVolume(cell, beam, rise, cell.size);
    else
        addLayers(beam, rise, float(bin_count) * bin_width, cell.size);
#else
    if (cell.pixel > 0.0) hideVolume(cell, beam, 0.0, cell.size);
#endif
}
#endif

// The place where a ray meets the picture.
struct Ray {
    Pair u, v;
};
vec2 computeDirection(Ray ray) { return vec2(ray.u.high, ray.v.high); }

// A vector in the frustum's axes.
struct Placed {
    Pair x, y, z;
};
vec3 rounded(Placed a) { return vec3(a.x.high, a.y.high, a.z.high); }

Pair multiplyDot(vec3 a, vec3 b) {
    return computeSum(computeSum(exactProduct(a.x, b.x), exactProduct(a.y, b.y)), exactProduct(a.z, b.z));
}
Pair difference(Pair a, Pair b) { return computeSum(a, negative(b)); }

// Transforms a normal, or another vector that transforms like normals.
Placed placed(ObjectRecord object, vec3 normal) {
    Pair x = multiplyDot(object.normal_x.xyz, normal), y = multiplyDot(object.normal_y.xyz, normal);
    Pair c = readPair(axis_cosine), s = readPair(axis_sine);
    return Placed(computeSum(product(c, x), product(s, y)), difference(product(c, y), product(s, x)),
                  multiplyDot(object.normal_z.xyz, normal));
}

float computeStrength(uint material) {
#ifdef HAVE_CERQUEIRA2017
    return materials[material].values.y * strength_scale;
#else
    return materials[material].values.x * strength_scale;
#endif
}

// The surface in a pixel: its triangle's plane in the frustum's axes, and properties of its material and object.
struct Seen {
    Placed normal;
    Pair distance;
    Pair normal_length;
    Ray ray;         // through the pixel's centre, or jittered
    float strength;  // at normal incidence
    float mapped;    // cosine of a mapped normal; 0: the plane's normal applies
    vec2 reach;      // inverse ranges of the object [1/m]
    float weight;    // pattern in elevation [1]
    uint material, triangle;
    vec3 axis;  // of the facet's lobe
};

// Distance of a plane from the sonar along its normal.
Pair computeDistance(PlaneRecord plane, ObjectRecord object) {
    vec3 n = plane.normal.xyz, point = plane.point.xyz, eye = object.eye.xyz, rest = object.eye_rest.xyz;
    Pair sum = Pair(plane.normal.w, 0.0);
    for (int i = 0; i < 3; ++i)
        sum = computeSum(sum, product(Pair(n[i], 0.0), computeSum(exactSum(point[i], -eye[i]), Pair(-rest[i], 0.0))));
    return sum;
}

// Length times the cosine of incidence, and the length of the ray.
Pair alongRay(Placed normal, Ray ray) {
    return computeSum(computeSum(normal.x, product(normal.y, ray.u)), product(normal.z, ray.v));
}
Pair lengthOfRay(Ray ray) {
    return root(computeSum(computeSum(Pair(1.0, 0.0), product(ray.u, ray.u)), product(ray.v, ray.v)));
}

Seen seenAt(ivec2 pixel, Ray ray) {
    Pair none = Pair(0.0, 0.0), one = Pair(1.0, 0.0);
    Seen seen = Seen(Placed(one, none, none), none, one, ray, 0.0, 0.0, vec2(0.0), 1.0, 0u, 0u, vec3(0.0));
#ifdef HAVE_ELEVATION_PATTERN
    seen.weight = elevationWeight(ray.u.high, ray.v.high);
#endif
    uvec4 texel = texelFetch(picture, pixel, 0);
    if (texel.x == 0u) return seen;
    CommandRecord command = commands[texel.x - 1u];
    ObjectRecord object = objects[command.object];
    seen.triangle = command.first_triangle + texel.y;
    PlaneRecord plane = PlaneRecord(planes[2u * seen.triangle], planes[2u * seen.triangle + 1u]);
    seen.normal = placed(object, plane.normal.xyz);
    seen.normal_length = root(computeSum(computeSum(product(seen.normal.x, seen.normal.x), product(seen.normal.y, seen.normal.y)),
                               product(seen.normal.z, seen.normal.z)));
    seen.distance = computeDistance(plane, object);
#ifdef HAVE_JITTER
    seen.ray.u = computeSum(ray.u, product(readPair(pixel_u), makeJitter(pixel, 0u)));
    seen.ray.v = computeSum(ray.v, product(readPair(pixel_v), makeJitter(pixel, 1u)));
#endif
    seen.strength = computeStrength(command.material);
#ifdef HAVE_NORMAL_MAP
    if (texel.z != 0u) seen.mapped = uintBitsToFloat(texel.z);
#endif
    seen.reach = object.extent.xy;
    seen.material = command.material;
#ifdef HAVE_BACKSCATTER_LAWS
    if (materials[seen.material].law.y > 0.0) seen.axis = normalize(rounded(placed(object, readFacet(seen.triangle).axis.xyz)));
#endif
    return seen;
}

// Index in share_starts of the begin of a pixel's shares; the next entry is their end.
uint computeShares(ivec2 pixel) {
#ifdef HAVE_CONICAL
    return uint(pixel.x + pixel.y * image_size.x);  // the boundaries of beams differ between rows
#else
    return uint(pixel.x);
#endif
}

// A direction as angles.
struct Angles {
    float cos_az, sin_az, cos_el, sin_el;
};
Angles computeAngles(vec2 uv) {
    float level = sqrt(1.0 + uv.x * uv.x), per_length = 1.0 / sqrt(1.0 + dot(uv, uv));
    return Angles(1.0 / level, uv.x / level, level * per_length, uv.y * per_length);
}

// A cell's footprint, and the distance of its plane.
struct Covered {
    Footprint footprint;
    float perpendicular;  // distance of the plane [m]; 0: no echo
};

// Returns the part of the plane along a ray that a cell covers, as planeFootprint() in C++. Sets `origin` and
// `pixel_place`.
Covered covered(Seen seen, Ray towards, PictureCell cell) {
    Angles at = computeAngles(computeDirection(towards));
    vec3 normal = rounded(seen.normal);
    Pair facing = quotient(alongRay(seen.normal, towards), lengthOfRay(towards));
    float ahead = normal.x * at.cos_az + normal.y * at.sin_az, aside = normal.y * at.cos_az - normal.x * at.sin_az;
    bool echo = seen.distance.high * facing.high > 0.0 && abs(facing.high) > EDGE_ON_COSINE * seen.normal_length.high;
    Pair inverse = Pair(0.0, 0.0), nearest = inverse;
    if (echo) {
        inverse = quotient(facing, seen.distance);
        nearest = quotient(seen.normal_length, seen.distance.high > 0.0 ? seen.distance : negative(seen.distance));
    }
    origin = inverse.high;
    pixel_place = inverse.low;
    PlaneExtent extent = planeExtent(ahead, aside, normal.z, at.cos_el, at.sin_el, echo ? 1.0 / seen.distance.high : 0.0,
                                     inverse.high, cell.width, cell.height, 0.0);
    Covered result;
    result.perpendicular = echo ? abs(seen.distance.high) / seen.normal_length.high : 0.0;
    result.footprint = trapezoidFootprint(inverse.high, pixel_place - extent.sag, extent.along, extent.across,
                                          beyond(nearest, origin), seen.reach.x - origin, seen.reach.y - origin, binEdge(0u),
                                          binEdge(bin_count), echo ? cell.size * seen.weight : 0.0);
    return result;
}

// Strength times slant range of a cell in the direction `towards` [m].
float strengthRange(Seen seen, Covered cell, vec2 towards, float width, float height) {
    float inverse_range = cell.footprint.pixel;
    bool mapped = seen.mapped > 0.0 && cell.perpendicular > 0.0;
#ifdef HAVE_BACKSCATTER_LAWS
    MaterialRecord material = materials[seen.material];
    if (!FOLLOWS_LAMBERT(material.law) && inverse_range > 0.0) {
        float cosine = mapped ? seen.mapped : min(cell.perpendicular * inverse_range, 1.0);
        LobeSlopes slopes = LobeSlopes(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        if (material.law.y > 0.0) {
            Angles at = computeAngles(towards);
            vec3 normal = rounded(seen.normal) / seen.normal_length.high;
            LobeView view = LobeView(Axis(normal.x, normal.y, normal.z), Axis(seen.axis.x, seen.axis.y, seen.axis.z),
                                     1.0 / inverse_range, at.cos_az, at.sin_az, at.cos_el, at.sin_el, width, height, seen.mapped);
            slopes = lobeSlopes(readFacet(seen.triangle), material.law.z, view);
        }
        return strength_scale / inverse_range * backscatterOverCosine(material.law, material.values.x, cosine, slopes);
    }
#endif
    return seen.strength * (mapped ? seen.mapped / inverse_range : cell.perpendicular);
}

// The middle of a share's cell of a pixel, and its height in v.
struct LookDirection {
    Ray towards;
    float rise;
};
LookDirection computeLookDirection(DeviceShare share, Ray ray) {
    Pair middle = readPair(share.middle), limit = readPair(share.limit);
    float lean = ray.v.high * share.shear * difference(middle, ray.u).high;
    PictureRow row = pictureRow(ray.v.low + lean, pixel_v.x, beyond(negative(limit), ray.v.high), beyond(limit, ray.v.high));
    return LookDirection(Ray(middle, exactSum(ray.v.high, row.middle)), row.rise);
}

void depositShare(DeviceShare share, Ray ray, Seen seen) {
    LookDirection look = computeLookDirection(share, ray);
    vec2 middle = computeDirection(look.towards);
    PictureCell cell = pictureCell(middle.x, middle.y, share.width, look.rise, 1.0 / (pixel_u.x * pixel_v.x));
#if defined(HAVE_NEAREST) || defined(HAVE_PUBLISHED)
    Ray towards = seen.ray;
#else
    Ray towards = look.towards;
    if (seen.mapped > 0.0) {
        float of_ray = alongRay(seen.normal, ray).high / lengthOfRay(ray).high;
        float of_cell = alongRay(seen.normal, towards).high / lengthOfRay(towards).high;
        if (of_ray * of_cell > 0.0) seen.mapped *= of_cell / of_ray;
    }
#endif
    vec2 uv = computeDirection(towards);
    Covered seen_cell = covered(seen, towards, cell);
    depositCell(seen_cell.footprint, share.beam, strengthRange(seen, seen_cell, uv, cell.width, cell.height));
#ifdef HAVE_VOLUME
    seen_cell.footprint.size = cell.size * seen.weight;
    depositVolume(seen_cell.footprint, share.beam, uv);
#endif
}

void depositPixel(ivec2 pixel, Ray ray, Seen seen) {
    uint at = computeShares(pixel);
    for (uint i = share_starts[at]; i < share_starts[at + 1u]; ++i) depositShare(shares[i], ray, seen);
}

// The approximate bin of a pixel's echo; bin_count: no echo.
uint firstBin(Seen seen) {
    float facing = alongRay(seen.normal, seen.ray).high / lengthOfRay(seen.ray).high;
    float inverse_range = seen.distance.high != 0.0 ? facing / seen.distance.high : 0.0;
    return inverse_range > 0.0 ? uint(min(1.0 / (inverse_range * bin_width), float(bin_count))) : bin_count;
}

// (place + 0.5) * size - extent.
Pair middle(int place, vec2 size, vec2 extent) {
    return difference(product(Pair(float(place) + 0.5, 0.0), readPair(size)), readPair(extent));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool inside = all(lessThan(pixel, image_size));
    Ray ray = Ray(middle(pixel.x, pixel_u, extent_u), middle(pixel.y, pixel_v, extent_v));
    Seen seen = seenAt(min(pixel, image_size - 1), ray);
    uint at = computeShares(min(pixel, image_size - 1)), share = share_starts[at];
    bool received = inside && share < share_starts[at + 1u];
    beginGroup(received ? shares[share].beam : 0u, received ? firstBin(seen) : bin_count);
    if (inside) depositPixel(pixel, ray, seen);
    endGroup();
}
