#include "components/sonar/rays/Scatterers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "components/sonar/base/RandomFields.hpp"
#include "types/geometry/VectorMath.hpp"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define INSONIFY_HAS_CLONES
#include <immintrin.h>
#define INSONIFY_DEFAULT_CLONE __attribute__((target("default")))
#else
#define INSONIFY_DEFAULT_CLONE
#endif

namespace insonify::sonar {

namespace {

/** Returns the strength that one scatterer of the lattice represents, relative to its mean: Gamma(shape), the
 *  distribution of the total of several scatterers of exponentially distributed strength. Uses Wilson and Hilferty's
 *  cube for shape + 1 (1931), and a power of a uniform number to get from there to `shape`. */
float gammaStrength(float shape, uint32_t bits) {
    const float next = shape + 1;
    const float normal = std::sqrt(-2 * logarithm(uniform(bits >> 16))) * computeCosine(uniform(bits) - 0.5f);
    const float root = std::max(0.0f, 1 - 1 / (9 * next) + normal / (3 * std::sqrt(next)));
    const float chance = uniform(mixed(bits + 0x9e3779b9u));
    return next / shape * root * root * root * std::exp(logarithm(chance) / shape);
}

/** Values of all scatterers of a patch on one lattice. */
struct Found {
    uint32_t key, base[2];  ///< The square of the middle.
    uint32_t cell_count;
    float cells_per_metre, turns_per_metre;
    bool conical;
    int32_t sum, next_sums[Patches::max_columns - 1];  ///< First sum of the beam; steps to that of the next column.
};

/** Finds the scatterer of each square of patch `i`, the sum that it adds to, its strength, and the phase of its path.
 */
INSONIFY_VECTOR_CLONES void locate(const Patches& patches, const LatticePatches& on, int i, const Found& found,
                                   const LatticeSquares& squares, int count, LatticeScatterers& __restrict scatterers) {
    const Found f = found;
    const float middle_u = on.middle_at[0][i], middle_v = on.middle_at[1][i], amplitude = on.amplitude[i];
    const float square_u = on.square[0][i], square_v = on.square[1][i], square_uu = on.square[2][i],
                square_uv = on.square[3][i], square_vv = on.square[4][i];
    const float up = on.up[0][i], up_u = on.up[1][i], up_v = on.up[2][i], aside_0 = on.aside[0][i],
                aside_u = on.aside[1][i], aside_v = on.aside[2][i], ahead_0 = on.ahead[0][i], ahead_u = on.ahead[1][i],
                ahead_v = on.ahead[2][i], ahead_per_range = f.conical ? 1 : 0;
    const float middle_range = static_cast<float>(on.range[i]), turns = on.turns[i];
    const auto near_end = static_cast<float>(on.near_here[i] - on.range[i]),
               far_end = static_cast<float>(on.far_here[i] - on.range[i]);
    float columns[Patches::max_columns + 1], rows[Patches::max_rows + 1];
    for (int k = 0; k <= Patches::max_columns; ++k) columns[k] = on.columns[k][i];
    for (int k = 0; k <= Patches::max_rows; ++k) rows[k] = patches.rows[k][i];
    const uint32_t seen = patches.seen[i];
    for (int j = 0; j < count; ++j) {
        const uint32_t bits = mixed(mixed(f.base[0] + static_cast<uint32_t>(squares.u[j]) + f.key) + f.base[1] +
                                    static_cast<uint32_t>(squares.v[j]));
        const float u = static_cast<float>(squares.u[j]) + uniform(bits) - middle_u;
        const float v = static_cast<float>(squares.v[j]) + uniform(bits >> 16) - middle_v;
        const float change = u * (square_u + square_uu * u + square_uv * v) + v * (square_v + square_vv * v);
        const float whole = middle_range * middle_range + change;
        const float range = std::sqrt(whole > 1e-12f ? whole : 1e-12f), sum = middle_range + range;
        const float per_both = 1 / (range * sum);  // one division for two
        const float further = change * per_both * range, per_range = per_both * sum;
        const float height = up + u * up_u + v * up_v;
        const float aside = aside_0 + u * aside_u + v * aside_v;
        const float ahead = ahead_0 + u * ahead_u + v * ahead_v + ahead_per_range * range;
        int32_t sample = 0, first_sum = f.sum;
        for (int k = 0; k < 3; ++k) {
            sample += height >= rows[k + 1] * range ? Patches::max_columns : 0;
            const bool past = aside >= columns[k + 1] * ahead;
            sample += past ? 1 : 0;
            first_sum += past ? f.next_sums[k] : 0;
        }
        const auto cell = static_cast<int32_t>(range * f.cells_per_metre);
        const int inside = (height >= rows[0] * range) & (height < rows[4] * range) & (aside >= columns[0] * ahead) &
                           (aside < columns[4] * ahead) & (further >= near_end) & (further < far_end) &
                           (static_cast<uint32_t>(cell) < f.cell_count) & static_cast<int>(seen >> sample);
        scatterers.bits[j] = bits;
        scatterers.size[j] = amplitude * per_range * per_range * per_range * (static_cast<float>(cell) + 0.5f);
        scatterers.turns[j] = turns + f.turns_per_metre * further;
        scatterers.sum[j] = (inside & 1) != 0 ? first_sum + static_cast<int32_t>(2 * static_cast<uint32_t>(cell)) : -1;
    }
}

/** Computes the fields of scatterers: complex Gaussian. */
INSONIFY_VECTOR_CLONES void radiate(int count, HeldScatterers& __restrict scatterers) {
    for (int i = 0; i < count; ++i) {
        const uint32_t power = mixed(scatterers.bits[i] + 0x632be5abu);
        const float field = scatterers.size[i] * std::sqrt(-logarithm(uniform(power)));
        const float phase = scatterers.turns[i] + uniform(power >> 16);
        const float turns = phase - nearest(phase);
        scatterers.real[i] = field * computeCosine(turns);
        scatterers.imaginary[i] = field * computeSine(turns);
    }
}

/** Rounds fields to quanta. */
INSONIFY_VECTOR_CLONES void countQuanta(const float* fields, int count, int64_t* __restrict quanta) {
    constexpr float capacity = 1048576;
    for (int i = 0; i < count; ++i) {
        const float low = fields[i] < capacity ? fields[i] : capacity, amount = low > -capacity ? low : -capacity;
        quanta[i] = static_cast<int64_t>(static_cast<double>(amount) * quanta_per_unit);
    }
}

/** Appends the scatterers inside their patch, in their order. */
INSONIFY_DEFAULT_CLONE void keepHeld(const LatticeScatterers& scatterers, int count, HeldScatterers& held) {
    for (int i = 0; i < count; ++i) {
        const int32_t sum = scatterers.sum[i];
        held.bits[held.count] = scatterers.bits[i];
        held.size[held.count] = scatterers.size[i];
        held.turns[held.count] = scatterers.turns[i];
        held.sum[held.count] = sum;
        held.count += sum >= 0 ? 1 : 0;
    }
}

#ifdef INSONIFY_HAS_CLONES
/** Does the same 16 at a time: compilers do not generate this instruction for loops. The extensions are named one by
 * one: with "arch=x86-64-v4" the intrinsics cannot be inlined if -march names a processor. */
__attribute__((target("avx512f,avx512bw,avx512cd,avx512dq,avx512vl"))) void keepHeld(
    const LatticeScatterers& scatterers, int count, HeldScatterers& held) {
    const void* const from[] = {scatterers.bits, scatterers.size, scatterers.turns, scatterers.sum};
    void* const to[] = {held.bits, held.size, held.turns, held.sum};
    for (int i = 0; i < count; i += LatticeSquares::at_once) {
        const __m512i sums = _mm512_load_si512(scatterers.sum + i);
        const uint32_t first_bits = (2u << std::min(count - i - 1, 15)) - 1;
        const auto mask = static_cast<__mmask16>(first_bits & _mm512_cmpge_epi32_mask(sums, _mm512_setzero_si512()));
        for (size_t k = 0; k < std::size(from); ++k) {
            const __m512i all = _mm512_load_si512(static_cast<const int32_t*>(from[k]) + i);
            _mm512_storeu_si512(static_cast<int32_t*>(to[k]) + held.count, _mm512_maskz_compress_epi32(mask, all));
        }
        held.count += std::popcount(static_cast<uint32_t>(mask));
    }
}
#endif

/** Returns the whole number below, for numbers far from the ends of int32_t. */
inline int32_t below(double x) {
    const auto whole = static_cast<int32_t>(x);
    return whole - (x < static_cast<double>(whole) ? 1 : 0);
}

inline double lesser(double a, double b) { return b < a ? b : a; }
inline double greater(double a, double b) { return a < b ? b : a; }

/** Sets the axes of the lattices of patches, which have one object, and the places of their middles on them. */
INSONIFY_VECTOR_CLONES void setAxes(const Patches& patches, const LatticeFrame& frame, int first, int end,
                                    LatticePatches& __restrict on) {
    const LatticeFrame f = frame;
    for (int i = first; i < end; ++i) {
        const double x = patches.normal[0][i], y = patches.normal[1][i], z = patches.normal[2][i],
                     distance = patches.distance[i];
        const double to_x = patches.middle[0][i], to_y = patches.middle[1][i], to_z = patches.middle[2][i];
        const double range = 1 / ((x * to_x + y * to_y + z * to_z) / distance);
        const double facing_0 = f.axes[0].x * x + f.axes[0].y * y + f.axes[0].z * z,
                     facing_1 = f.axes[1].x * x + f.axes[1].y * y + f.axes[1].z * z,
                     facing_2 = f.axes[2].x * x + f.axes[2].y * y + f.axes[2].z * z;
        const double size_0 = std::abs(facing_0), size_1 = std::abs(facing_1), size_2 = std::abs(facing_2);
        const double is_0 = (size_0 >= size_1) & (size_0 >= size_2) ? 1 : 0, is_1 = size_1 >= size_2 ? 1 : 0;
        const auto choose = [=](double a, double b, double c) { return is_0 > 0 ? a : is_1 > 0 ? b : c; };
        const double facing = choose(facing_0, facing_1, facing_2);
        const auto setAxis = [&](int k, int a, int b, int c) {
            const double part =
                choose(a == 1 ? facing_1 : facing_2, b == 2 ? facing_2 : facing_0, c == 0 ? facing_0 : facing_1) /
                facing;
            double across[3];
            for (int j = 0; j < 3; ++j) {
                on.along[k][j][i] = choose(f.axes[a][j], f.axes[b][j], f.axes[c][j]) -
                                    part * choose(f.axes[0][j], f.axes[1][j], f.axes[2][j]);
                on.inverse[k][j][i] = across[j] = choose(f.inverse[a][j], f.inverse[b][j], f.inverse[c][j]);
            }
            on.middle[k][i] = choose(f.place[a], f.place[b], f.place[c]) +
                              range * (across[0] * to_x + across[1] * to_y + across[2] * to_z);
        };
        setAxis(0, 1, 2, 0);
        setAxis(1, 2, 0, 1);
        on.range[i] = range;
        // The cross product of both along the plane is its normal times volume / facing.
        on.area_height[i] = f.volume * std::abs(distance / facing);
        on.side[i] = static_cast<uint32_t>(static_cast<int32_t>(choose(0, 2, 4) + (facing * distance < 0 ? 1 : 0)));
    }
}

/** Sets the slant ranges that patches may reach, between two inverse ranges: 1/r on a plane is a linear function of the
 *  direction. And the edges of their columns. `planar`: 1, or 0 for conical beams. */
INSONIFY_VECTOR_CLONES void setReach(const Patches& patches, double planar, double front, double back,
                                     LatticePatches& __restrict on) {
    for (int i = 0; i < patches.count; ++i) {
        const double x = patches.normal[0][i], y = patches.normal[1][i], z = patches.normal[2][i],
                     distance = patches.distance[i];
        const double nearest_inverse = std::sqrt(x * x + y * y + z * z) / std::abs(distance);
        const double width = patches.width[i], height = patches.height[i];
        const double bulge = nearest_inverse * (width * width + height * height) / 8;
        double low = (x * patches.middle[0][i] + y * patches.middle[1][i] + z * patches.middle[2][i]) / distance;
        double high = low;
        for (int k = 0; k < Patches::corners; ++k) {
            const bool is_low = k == 0 || k == 3;
            const double cosine = is_low ? patches.low_cosine[i] : patches.high_cosine[i];
            const double inverse =
                (x * (cosine * patches.corner_cosine[k][i]) + y * (cosine * patches.corner_sine[k][i]) +
                 z * (is_low ? patches.low_sine[i] : patches.high_sine[i])) /
                distance;
            on.corner_inverse[k][i] = inverse;
            low = lesser(low, inverse);
            high = greater(high, inverse);
        }
        on.near[i] = 1 / lesser(lesser(high + bulge, nearest_inverse), front);
        on.far[i] = patches.strength_range[i] > 0 ? 1 / greater(low - bulge, back) : 0;
        const double cosine = patches.bearing_cosine[i], sine = patches.bearing_sine[i];
        for (int k = 0; k <= Patches::max_columns; ++k) {
            const double to_cosine = patches.edge_cosine[k][i], to_sine = patches.edge_sine[k][i];
            const double tangent =
                (to_sine * cosine - to_cosine * sine) / greater(to_cosine * cosine + to_sine * sine, 1e-9);
            on.columns[k][i] = static_cast<float>(planar * tangent + (1 - planar) * to_sine);
        }
    }
}

/** Sets what the scatterers of patches on a lattice have in common. */
INSONIFY_VECTOR_CLONES void setParts(const Patches& patches, const EchoRules& rules, const LatticeLevel& level,
                                     double begin, LatticePatches& __restrict on) {
    const double spacing = level.spacing, range_end = level.range_end, turns_per_metre = rules.turns_per_metre,
                 size = rules.bins.bin_width * level.spacing;
    const double planar = rules.features.has(Feature::Conical) ? 0 : 1;
    for (int i = 0; i < patches.count; ++i) {
        on.near_here[i] = greater(on.near[i], begin);
        on.far_here[i] = lesser(on.far[i], range_end);
        for (int k = 0; k < 2; ++k) {
            const double at = on.middle[k][i] / spacing, base = std::floor(at);
            on.base[k][i] = base;
            on.middle_at[k][i] = static_cast<float>(at - base);
        }
        const double range = on.range[i];
        const double at_x = range * patches.middle[0][i], at_y = range * patches.middle[1][i],
                     at_z = range * patches.middle[2][i];
        const double u_x = spacing * on.along[0][0][i], u_y = spacing * on.along[0][1][i],
                     u_z = spacing * on.along[0][2][i];
        const double v_x = spacing * on.along[1][0][i], v_y = spacing * on.along[1][1][i],
                     v_z = spacing * on.along[1][2][i];
        on.square[0][i] = static_cast<float>(2 * (at_x * u_x + at_y * u_y + at_z * u_z));
        on.square[1][i] = static_cast<float>(2 * (at_x * v_x + at_y * v_y + at_z * v_z));
        on.square[2][i] = static_cast<float>(u_x * u_x + u_y * u_y + u_z * u_z);
        on.square[3][i] = static_cast<float>(2 * (u_x * v_x + u_y * v_y + u_z * v_z));
        on.square[4][i] = static_cast<float>(v_x * v_x + v_y * v_y + v_z * v_z);
        const double cosine = planar * patches.bearing_cosine[i] + (1 - planar),
                     sine = planar * patches.bearing_sine[i];
        on.up[0][i] = static_cast<float>(at_z);
        on.up[1][i] = static_cast<float>(u_z);
        on.up[2][i] = static_cast<float>(v_z);
        on.aside[0][i] = static_cast<float>(cosine * at_y - sine * at_x);
        on.aside[1][i] = static_cast<float>(cosine * u_y - sine * u_x);
        on.aside[2][i] = static_cast<float>(cosine * v_y - sine * v_x);
        on.ahead[0][i] = static_cast<float>(planar * (cosine * at_x + sine * at_y));
        on.ahead[1][i] = static_cast<float>(planar * (cosine * u_x + sine * u_y));
        on.ahead[2][i] = static_cast<float>(planar * (cosine * v_x + sine * v_y));
        const double turns = turns_per_metre * range;
        on.turns[i] = static_cast<float>(turns - std::floor(turns));
        on.amplitude[i] = static_cast<float>(
            size * std::sqrt(patches.strength_range[i] * patches.per_solid_angle[i] * on.area_height[i]));
    }
}

/** Sets boxes around outlines: about their corners, with the slant range of each between the lattice's. */
INSONIFY_VECTOR_CLONES void setBoxes(const Patches& patches, double spacing, LatticePatches& __restrict on) {
    const double per_spacing = 1 / spacing;
    for (int i = 0; i < patches.count; ++i) {
        const double near = on.near_here[i], far = on.far_here[i], range = on.range[i];
        const double to_x = patches.middle[0][i], to_y = patches.middle[1][i], to_z = patches.middle[2][i];
        const double u_x = on.inverse[0][0][i], u_y = on.inverse[0][1][i], u_z = on.inverse[0][2][i];
        const double v_x = on.inverse[1][0][i], v_y = on.inverse[1][1][i], v_z = on.inverse[1][2][i];
        double cut = 0, low_u = 0, high_u = 0, low_v = 0, high_v = 0;
        const auto contain = [&](int k, double cosine, double sine) {
            const double whole = 1 / greater(on.corner_inverse[k][i], 1e-9), to = lesser(greater(whole, near), far);
            const double x = to * (cosine * patches.corner_cosine[k][i]) - to_x * range,
                         y = to * (cosine * patches.corner_sine[k][i]) - to_y * range, z = to * sine - to_z * range;
            const double u = u_x * x + u_y * y + u_z * z, v = v_x * x + v_y * y + v_z * z;
            low_u = lesser(low_u, u);
            high_u = greater(high_u, u);
            low_v = lesser(low_v, v);
            high_v = greater(high_v, v);
            cut = to == whole ? cut : 1;
        };
        contain(0, patches.low_cosine[i], patches.low_sine[i]);
        contain(1, patches.high_cosine[i], patches.high_sine[i]);
        contain(2, patches.high_cosine[i], patches.high_sine[i]);
        contain(3, patches.low_cosine[i], patches.low_sine[i]);
        // A corner that is cut off is outside the plane, by less than the patch's height and width. Curved sides and
        // the parts of a plane about the nearest point are within less than those of a sphere.
        const double up_x = -to_z * to_x, up_y = -to_z * to_y, up_z = 1 - to_z * to_z,
                     across = std::sqrt(greater(to_x * to_x + to_y * to_y, 1e-30));
        const double width = patches.width[i], height = patches.height[i];
        const double rise = cut * far * height / across, shift = cut * far * width;
        const double margin_u = on.excess[i] + std::abs(u_x * up_x + u_y * up_y + u_z * up_z) * rise +
                                std::abs(u_y * to_x - u_x * to_y) * shift,
                     margin_v = on.excess[i] + std::abs(v_x * up_x + v_y * up_y + v_z * up_z) * rise +
                                std::abs(v_y * to_x - v_x * to_y) * shift;
        const double at_u = on.middle[0][i] * per_spacing - on.base[0][i],
                     at_v = on.middle[1][i] * per_spacing - on.base[1][i];
        on.box_low[0][i] = at_u + (low_u - margin_u) * per_spacing;
        on.box_high[0][i] = at_u + (high_u + margin_u) * per_spacing;
        on.box_low[1][i] = at_v + (low_v - margin_v) * per_spacing;
        on.box_high[1][i] = at_v + (high_v + margin_v) * per_spacing;
        on.rows_are_u[i] = high_u - low_u + 2 * margin_u < high_v - low_v + 2 * margin_v ? 1 : 0;
    }
}

/** Sets the half plane of the side from corner A to corner B, as far as its slant ranges are the lattice's. The
 *  excess of a conic over its chord is s (1 - s) / inverse range, times a constant, where s is from 0 to 1 on the
 * chord. */
template <int A, int B, bool is_straight>
inline void setSide(const Patches& patches, double spacing, int side, LatticePatches& __restrict on) {
    constexpr bool is_row = (A == 0 && B == 3) || (A == 1 && B == 2);
    constexpr bool from_low = A == 0 || A == 3, to_low = B == 0 || B == 3;
    const double per_spacing = 1 / spacing;
    for (int i = 0; i < patches.count; ++i) {
        const double low = on.low_inverse[i], high = on.high_inverse[i];
        const double from_cosine = from_low ? patches.low_cosine[i] : patches.high_cosine[i],
                     to_cosine = to_low ? patches.low_cosine[i] : patches.high_cosine[i];
        const double x = from_cosine * patches.corner_cosine[A][i], y = from_cosine * patches.corner_sine[A][i],
                     z = from_low ? patches.low_sine[i] : patches.high_sine[i];
        const double step_x = to_cosine * patches.corner_cosine[B][i] - x,
                     step_y = to_cosine * patches.corner_sine[B][i] - y,
                     step_z = (to_low ? patches.low_sine[i] : patches.high_sine[i]) - z;
        // On the chord the inverse range over the direction's length is a linear function.
        const double inverse = on.corner_inverse[A][i], change = on.corner_inverse[B][i] - inverse;
        double first = 0, last = 1, is_there = 0;
        if constexpr (is_straight) {
            const double per_change = 1 / (std::abs(change) > 1e-12 ? change : 1e-12);
            const double at_low = (low - inverse) * per_change, at_high = (high - inverse) * per_change;
            const double begin = greater(lesser(at_low, at_high), 0), end = lesser(greater(at_low, at_high), 1);
            is_there = begin < end ? 1 : 0;
            first = is_there * begin;
            last = is_there * end;
        } else {
            const double other = inverse + change;
            is_there = (lesser(inverse, other) >= low) & (greater(inverse, other) <= high) ? 1 : 0;
        }
        const double u_x = on.inverse[0][0][i], u_y = on.inverse[0][1][i], u_z = on.inverse[0][2][i];
        const double v_x = on.inverse[1][0][i], v_y = on.inverse[1][1][i], v_z = on.inverse[1][2][i];
        const double range = on.range[i], middle_x = patches.middle[0][i] * range,
                     middle_y = patches.middle[1][i] * range, middle_z = patches.middle[2][i] * range;
        const double first_range = 1 / greater(inverse + first * change, 1e-9),
                     last_range = 1 / greater(inverse + last * change, 1e-9);
        const double a_x = first_range * (x + first * step_x) - middle_x,
                     b_x = last_range * (x + last * step_x) - middle_x;
        const double a_y = first_range * (y + first * step_y) - middle_y,
                     b_y = last_range * (y + last * step_y) - middle_y;
        const double a_z = first_range * (z + first * step_z) - middle_z,
                     b_z = last_range * (z + last * step_z) - middle_z;
        const double a_u = u_x * a_x + u_y * a_y + u_z * a_z, a_v = v_x * a_x + v_y * a_y + v_z * a_z;
        const double out_u = v_x * b_x + v_y * b_y + v_z * b_z - a_v, out_v = a_u - (u_x * b_x + u_y * b_y + u_z * b_z);
        const double length = std::sqrt(out_u * out_u + out_v * out_v);
        double beyond = 1e-3 * spacing * length;  // single precision of scatterers
        if constexpr (!is_straight) {  // the side nearest to its middle: of an elevation, or of a cone, whose y is
                                       // constant
            const double half_x = x + step_x / 2, half_y = y + step_y / 2, half_z = z + step_z / 2;
            const double scale = from_cosine / std::sqrt(greater(half_x * half_x + half_y * half_y, 1e-30));
            const double side_x = is_row ? scale * half_x : std::sqrt(greater(1 - half_z * half_z - y * y, 0)),
                         side_y = is_row ? scale * half_y : y;
            const double side_inverse = greater(
                (patches.normal[0][i] * side_x + patches.normal[1][i] * side_y + patches.normal[2][i] * half_z) /
                    patches.distance[i],
                1e-9);
            const double side_range = 1 / side_inverse;
            const double c_x = side_range * side_x - middle_x, c_y = side_range * side_y - middle_y,
                         c_z = side_range * half_z - middle_z;
            const double further = greater(greater(first_range, last_range) * side_inverse, 1);
            beyond += 1.01 * further *
                      std::abs((u_x * c_x + u_y * c_y + u_z * c_z - a_u) * out_u +
                               (v_x * c_x + v_y * c_y + v_z * c_z - a_v) * out_v);
            on.excess[i] = greater(on.excess[i], is_there * beyond / greater(length, 1e-30));
        }
        // The middle of the patch is inside, or outside where its direction meets the plane behind the sonar.
        const double over = out_u * a_u + out_v * a_v, turn = over * range < 0 ? -1 : 1;
        const double kept = is_there * (length > 1e-6 * spacing ? turn : 0);
        const double at = out_u * on.middle_at[0][i] + out_v * on.middle_at[1][i];
        on.out[0][side][i] = kept * out_u;
        on.out[1][side][i] = kept * out_v;
        on.end[side][i] = kept * (at + over * per_spacing) + std::abs(kept) * beyond * per_spacing;
    }
}

/** Sets half planes whose intersection contains outlines. `planar` as above. */
INSONIFY_VECTOR_CLONES __attribute__((flatten)) void setSides(const Patches& patches, double planar, double spacing,
                                                              LatticePatches& __restrict on) {
    for (int i = 0; i < patches.count; ++i) {
        const double width = patches.width[i], height = patches.height[i];
        on.excess[i] = on.far_here[i] * (width * width + height * height) / 8;
        // The squared slant range is convex: the far end is before the tangent on which it is that of the far end.
        const double far = on.far_here[i], range = on.range[i];
        const double out_u = on.square[0][i], out_v = on.square[1][i];
        on.low_inverse[i] = 1 / far;
        on.high_inverse[i] = 1 / on.near_here[i];
        on.out[0][LatticePatches::far_side][i] = out_u;
        on.out[1][LatticePatches::far_side][i] = out_v;
        on.end[LatticePatches::far_side][i] =
            far * far - range * range + 1e-5 * far * far + out_u * on.middle_at[0][i] + out_v * on.middle_at[1][i];
    }
    if (planar > 0) {
        setSide<0, 1, true>(patches, spacing, 0, on);
        setSide<3, 2, true>(patches, spacing, 1, on);
    } else {
        setSide<0, 1, false>(patches, spacing, 0, on);
        setSide<3, 2, false>(patches, spacing, 1, on);
    }
    setSide<0, 3, false>(patches, spacing, 2, on);
    setSide<1, 2, false>(patches, spacing, 3, on);
}

/** Sets the rows of squares of boxes, which are counted along their shorter side, and the ends of rows on half planes.
 */
INSONIFY_VECTOR_CLONES void setRows(int count, LatticePatches& __restrict on) {
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    for (int i = 0; i < count; ++i) {
        const double swapped = on.rows_are_u[i], kept = 1 - swapped;
        on.first[i] = below(kept * on.box_low[1][i] + swapped * on.box_low[0][i]);
        on.last[i] = below(kept * on.box_high[1][i] + swapped * on.box_high[0][i]);
        on.first_across[i] = below(kept * on.box_low[0][i] + swapped * on.box_low[1][i]);
        on.last_across[i] = below(kept * on.box_high[0][i] + swapped * on.box_high[1][i]);
        for (int k = 0; k < LatticePatches::sides; ++k) {
            const double out_u = on.out[0][k][i], out_v = on.out[1][k][i];
            const double end = on.end[k][i] - lesser(out_u, 0) - lesser(out_v, 0);
            const double across = kept * out_u + swapped * out_v, up = kept * out_v + swapped * out_u;
            const double at_zero = end / across, slope = -up / across;
            on.low[k][i] = across < 0 ? at_zero : -unbounded;
            on.low_slope[k][i] = across < 0 ? slope : 0;
            on.high[k][i] = across > 0 ? at_zero : unbounded;
            on.high_slope[k][i] = across > 0 ? slope : 0;
        }
    }
}

/** Ends of rows of squares that are computed together. */
struct RowEnds {
    static constexpr int at_once = 8;
    using Rows = double __attribute__((vector_size(at_once * sizeof(double))));
    using RowInts = int32_t __attribute__((vector_size(at_once * sizeof(int32_t))));
    alignas(64) int32_t first[at_once], last[at_once];

    /** Sets the first and the last square of rows of patch `patch` from `row`, along the other axis. */
    void set(const LatticePatches& on, int patch, int32_t row) {
        const Rows at = static_cast<double>(row) + Rows{0, 1, 2, 3, 4, 5, 6, 7};
        const double before = on.first_across[patch] - 1.0, to = on.last_across[patch];
        Rows low = before + 1 + Rows{}, high = to + Rows{};
        for (int k = 0; k < LatticePatches::sides; ++k) {
            const Rows low_end = on.low[k][patch] + at * on.low_slope[k][patch],
                       high_end = on.high[k][patch] + at * on.high_slope[k][patch];
            low = low < low_end ? low_end : low;
            high = high_end < high ? high_end : high;
        }
        low = to + 1 < low ? to + 1 + Rows{} : low;
        high = high < before ? before + Rows{} : high;
        const RowInts above = __builtin_convertvector(low, RowInts), below = __builtin_convertvector(high, RowInts);
        const RowInts starts = above - __builtin_convertvector(__builtin_convertvector(above, Rows) < low, RowInts),
                      ends = below + __builtin_convertvector(high < __builtin_convertvector(below, Rows), RowInts);
        std::memcpy(first, &starts, sizeof first);
        std::memcpy(last, &ends, sizeof last);
    }
};

/** Squares of a row. */
using SquaresAtOnce = int32_t __attribute__((vector_size(LatticeSquares::at_once * sizeof(int32_t))));
constexpr SquaresAtOnce upwards{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

int wholeVectors(int count) { return (count + LatticeSquares::at_once - 1) & ~(LatticeSquares::at_once - 1); }

}  // namespace

LatticeFrame::LatticeFrame(const ObjectRecord& object) {
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 column(object.row_x[i], object.row_y[i], object.row_z[i]);
        const double scale = glm::length(column);
        axes[i] = column / scale;
        inverse[i] = scale * glm::dvec3(object.normal_x[i], object.normal_y[i], object.normal_z[i]);
        place[i] = scale * (double{object.eye[i]} + double{object.eye_rest[i]});
    }
    volume = std::abs(glm::determinant(axes));
}

void Scatterers::deposit() {
    for (int first = 0, end = 0; first < patches.count; first = end) {
        const uint32_t object = patches.object[first];
        while (end < patches.count && patches.object[end] == object) ++end;
        if (frame_of_ != object) frame_ = LatticeFrame(objects_[object]);
        frame_of_ = object;
        setAxes(patches, frame_, first, end, on_lattice_);
    }
    setReach(patches, rules_.features.has(Feature::Conical) ? 0 : 1, rules_.edges.front(),
             rules_.edges[static_cast<size_t>(rules_.bins.bin_count)], on_lattice_);
    double begin = 0;
    for (const LatticeLevel& level : rules_.lattice) {
        bool is_reached = false;
        for (int i = 0; i < patches.count; ++i)
            is_reached =
                is_reached || greater(on_lattice_.near[i], begin) < lesser(on_lattice_.far[i], level.range_end);
        if (is_reached) depositLevel(level, begin);
        begin = level.range_end;
    }
    patches.count = 0;
}

void Scatterers::depositLevel(const LatticeLevel& level, double begin) {
    const double planar = rules_.features.has(Feature::Conical) ? 0 : 1;
    setParts(patches, rules_, level, begin, on_lattice_);
    setSides(patches, planar, level.spacing, on_lattice_);
    setBoxes(patches, level.spacing, on_lattice_);
    setRows(patches.count, on_lattice_);
    for (int i = 0; i < patches.count; ++i)
        if (on_lattice_.near_here[i] < on_lattice_.far_here[i]) addRows(i, level);
    add();
}

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void Scatterers::addRows(int i, const LatticeLevel& level) {
    const bool swapped = on_lattice_.rows_are_u[i] != 0;
    int32_t* const across = swapped ? squares_.v : squares_.u;
    int32_t* const up = swapped ? squares_.u : squares_.v;
    RowEnds ends;
    int count = 0;
    for (int32_t first = on_lattice_.first[i], row = first; row <= on_lattice_.last[i]; ++row) {
        const int k = (row - first) % RowEnds::at_once;
        if (k == 0) ends.set(on_lattice_, i, row);
        for (int32_t at = ends.first[k], last = ends.last[k]; at <= last; at += LatticeSquares::at_once) {
            if (count > LatticeSquares::capacity - LatticeSquares::at_once) {
                find(i, level, count);
                count = 0;
            }
            const SquaresAtOnce run = at + upwards, same = row + SquaresAtOnce{};
            std::memcpy(across + count, &run, sizeof run);
            std::memcpy(up + count, &same, sizeof same);
            count += std::min(last - at + 1, LatticeSquares::at_once);
        }
    }
    find(i, level, count);
}

void Scatterers::find(int i, const LatticeLevel& level, int count) {
    const auto sums = static_cast<int32_t>(rules_.sumCount());
    Found found{mixed(patches.number[i] * 6 + on_lattice_.side[i] + mixed(level.number + 1)),
                {makeSquare(on_lattice_.base[0][i]), makeSquare(on_lattice_.base[1][i])},
                static_cast<uint32_t>(rules_.bins.bin_count),
                static_cast<float>(1 / rules_.bins.bin_width),
                static_cast<float>(rules_.turns_per_metre),
                rules_.features.has(Feature::Conical),
                static_cast<int32_t>(patches.beams[0][i]) * sums,
                {}};
    for (size_t k = 0; k + 1 < Patches::max_columns; ++k)
        found.next_sums[k] = static_cast<int32_t>(patches.beams[k + 1][i] - patches.beams[k][i]) * sums;
    locate(patches, on_lattice_, i, found, squares_, wholeVectors(count), scatterers_);
    const int before = held_.count;
    keepHeld(scatterers_, count, held_);
    for (int k = before; level.represents > 0 && k < held_.count; ++k)
        held_.size[k] *=
            std::sqrt(gammaStrength(static_cast<float>(level.represents), mixed(held_.bits[k] + 0x5bd1e995u)));
    if (held_.count > HeldScatterers::capacity - LatticeSquares::capacity) add();
}

void Scatterers::add() {
    const int whole = wholeVectors(held_.count);
    radiate(whole, held_);
    countQuanta(held_.real, whole, held_.real_quanta);
    countQuanta(held_.imaginary, whole, held_.imaginary_quanta);
    for (int i = 0; i < held_.count; ++i) {
        uint64_t* const sums = sums_ + held_.sum[i];
        sums[0] += static_cast<uint64_t>(held_.real_quanta[i]);
        sums[1] += static_cast<uint64_t>(held_.imaginary_quanta[i]);
    }
    held_.count = 0;
}

}  // namespace insonify::sonar
