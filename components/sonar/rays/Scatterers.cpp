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

/** Common values of all scatterers of a patch on one lattice. They are u and v spacings from its middle. */
struct LatticePatch {
    /** A linear function of u and v: constant + u * along_u + v * along_v. */
    struct Plane {
        float constant, along_u, along_v;
    };
    uint32_t key, base_u, base_v;  ///< The square of the middle.
    float middle_u, middle_v;      ///< Place of the middle in its square [spacings].
    float range;                   ///< Slant range of the middle [m].
    float square_u, square_v, square_uu, square_uv,
        square_vv;               ///< Change of the squared slant range from the middle.
    Plane height, aside, ahead;  ///< In the direction of the middle's bearing [m].
    float ahead_per_range;
    Plane front;  ///< Of conical beams, along x: a cone goes on behind the sonar. Else 1.
    float columns[Patch::max_columns + 1], rows[Patch::max_rows + 1];
    uint32_t seen;
    int32_t sum, next_sums[Patch::max_columns - 1];  ///< First sum of the beam; steps to that of the next column.
    float near_end, far_end;                         ///< Slant ranges, relative to the middle's [m].
    float amplitude;               ///< Factor of the square root of a power over the square of the range.
    float turns, turns_per_metre;  ///< Phase of the middle, two way.
    float cells_per_metre;
    uint32_t cell_count;
};

/** A patch in the coordinates of the lattice of its object: two of the object's axes, in metres. */
struct PatchLattice {
    PatchLattice(const Patch& patch, const LatticeFrame& frame);

    /** Returns the components of a vector from the middle along the two axes [m]. */
    glm::dvec2 across(const glm::dvec3& from_middle) const {
        return {glm::dot(*inverse[0], from_middle), glm::dot(*inverse[1], from_middle)};
    }
    const glm::dvec3* inverse[2];
    glm::dvec3 along[2];  ///< Step on the plane per metre along each axis [m].
    glm::dvec2 middle;    ///< Place of the patch's middle [m].
    double range;         ///< Slant range of the middle [m].
    uint32_t side;        ///< The axis that the patch faces most, and whether from behind: 0 to 5.
    double area_height;   ///< Area of the plane per square metre of the lattice, times its distance from the sonar [m].
};

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

/** Finds the place of each square's scatterer in its square. */
INSONIFY_VECTOR_CLONES void place(const LatticePatch& patch, const LatticeSquares& squares, int count,
                                  LatticeScatterers& __restrict scatterers) {
    const LatticePatch p = patch;
    for (int i = 0; i < count; ++i) {
        const uint32_t bits = mixed(mixed(p.base_u + static_cast<uint32_t>(squares.u[i]) + p.key) + p.base_v +
                                    static_cast<uint32_t>(squares.v[i]));
        scatterers.bits[i] = bits;
        scatterers.u[i] = static_cast<float>(squares.u[i]) + uniform(bits) - p.middle_u;
        scatterers.v[i] = static_cast<float>(squares.v[i]) + uniform(bits >> 16) - p.middle_v;
    }
}

/** Computes the sum that each scatterer adds to, its strength, and the phase of its sound path. */
INSONIFY_VECTOR_CLONES void locate(const LatticePatch& patch, int count, LatticeScatterers& __restrict scatterers) {
    const LatticePatch p = patch;
    for (int i = 0; i < count; ++i) {
        const float u = scatterers.u[i], v = scatterers.v[i];
        const float change = u * (p.square_u + p.square_uu * u + p.square_uv * v) + v * (p.square_v + p.square_vv * v);
        const float square = p.range * p.range + change;
        const float range = std::sqrt(square > 1e-12f ? square : 1e-12f), sum = p.range + range;
        const float per_both = 1 / (range * sum);  // one division for two
        const float further = change * per_both * range, per_range = per_both * sum;
        const float height = p.height.constant + u * p.height.along_u + v * p.height.along_v;
        const float aside = p.aside.constant + u * p.aside.along_u + v * p.aside.along_v;
        const float ahead = p.ahead.constant + u * p.ahead.along_u + v * p.ahead.along_v + p.ahead_per_range * range;
        const float front = p.front.constant + u * p.front.along_u + v * p.front.along_v;
        int32_t sample = 0, first_sum = p.sum;
        for (int k = 0; k < 3; ++k) {
            sample += height >= p.rows[k + 1] * range ? Patch::max_columns : 0;
            const bool past = aside >= p.columns[k + 1] * ahead;
            sample += past ? 1 : 0;
            first_sum += past ? p.next_sums[k] : 0;
        }
        const auto cell = static_cast<int32_t>(range * p.cells_per_metre);
        const int inside = (front >= 0) & (height >= p.rows[0] * range) & (height < p.rows[4] * range) &
                           (aside >= p.columns[0] * ahead) & (aside < p.columns[4] * ahead) & (further >= p.near_end) &
                           (further < p.far_end) & (static_cast<uint32_t>(cell) < p.cell_count) &
                           static_cast<int>(p.seen >> sample);
        scatterers.size[i] = p.amplitude * per_range * per_range * per_range * (static_cast<float>(cell) + 0.5f);
        scatterers.turns[i] = p.turns + p.turns_per_metre * further;
        scatterers.sum[i] = (inside & 1) != 0 ? first_sum + static_cast<int32_t>(2 * static_cast<uint32_t>(cell)) : -1;
    }
}

/** Computes the fields of scatterers: complex Gaussian. */
INSONIFY_VECTOR_CLONES void radiate(int count, LatticeScatterers& __restrict scatterers) {
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

/** Keeps the scatterers inside the patch, in their order. Returns their number. */
INSONIFY_DEFAULT_CLONE int keepHeld(int count, LatticeScatterers& scatterers) {
    int held = 0;
    for (int i = 0; i < count; ++i) {
        const int32_t sum = scatterers.sum[i];
        scatterers.bits[held] = scatterers.bits[i];
        scatterers.size[held] = scatterers.size[i];
        scatterers.turns[held] = scatterers.turns[i];
        scatterers.sum[held] = sum;
        held += sum >= 0 ? 1 : 0;
    }
    return held;
}

#ifdef INSONIFY_HAS_CLONES
/** Does the same 16 at a time: compilers do not generate this instruction for loops. The extensions are named one by
 * one: with "arch=x86-64-v4" the intrinsics cannot be inlined if -march names a processor. */
__attribute__((target("avx512f,avx512bw,avx512cd,avx512dq,avx512vl"))) int keepHeld(int count,
                                                                                    LatticeScatterers& scatterers) {
    void* const arrays[] = {scatterers.bits, scatterers.size, scatterers.turns, scatterers.sum};
    int held = 0;
    for (int i = 0; i < count; i += LatticeSquares::at_once) {
        const __m512i sums = _mm512_load_si512(scatterers.sum + i);
        const uint32_t first_bits = (2u << std::min(count - i - 1, 15)) - 1;
        const auto mask = static_cast<__mmask16>(first_bits & _mm512_cmpge_epi32_mask(sums, _mm512_setzero_si512()));
        for (void* const array : arrays) {
            const __m512i all = _mm512_load_si512(static_cast<int32_t*>(array) + i);
            _mm512_storeu_si512(static_cast<int32_t*>(array) + held, _mm512_maskz_compress_epi32(mask, all));
        }
        held += std::popcount(static_cast<uint32_t>(mask));
    }
    return held;
}
#endif

/** An interval. */
struct Span {
    double low, high;
};

/** Returns the whole number below, for numbers far from the ends of int32_t. */
int32_t below(double x) {
    const auto whole = static_cast<int32_t>(x);
    return whole - (x < static_cast<double>(whole) ? 1 : 0);
}

/** The outline of a patch on its lattice, relative to the square that contains its middle [spacings]. */
struct PatchOutline {
    std::array<glm::dvec2, 4> corners;
    glm::dvec2 margin;  ///< Max excess of its curved sides, or of the whole outline over its corners.

    Span extent(int axis) const {
        const double a = corners[0][axis], b = corners[1][axis], c = corners[2][axis], d = corners[3][axis];
        return {std::min(std::min(a, b), std::min(c, d)) - margin[axis],
                std::max(std::max(a, b), std::max(c, d)) + margin[axis]};
    }
};

/** The squares of a lattice that an outline intersects, row by row. */
class OutlineRows {
public:
    /** Rows are counted along the axis in which the outline is shorter. */
    explicit OutlineRows(const PatchOutline& outline) {
        const Span u = outline.extent(0), v = outline.extent(1);
        axis_ = v.high - v.low <= u.high - u.low ? 1 : 0;
        const Span rows = axis_ == 1 ? v : u, across = axis_ == 1 ? u : v;
        first = below(rows.low);
        last = below(rows.high);
        first_across_ = below(across.low);
        last_across_ = below(across.high);
        if ((last - first + 1.0) * (last_across_ - first_across_ + 1.0) > LatticeSquares::at_once) setSides(outline);
    }
    bool isAlong(int axis) const { return axis == axis_; }
    /** Rows whose ends are computed together. */
    static constexpr int at_once = 8;
    struct Ends {
        alignas(64) int32_t first[at_once], last[at_once];
    };
    /** Sets the first and the last square of rows from `row`, along the other axis. */
    void setEnds(int32_t row, Ends& ends) const {
        const Side low_a = lows_[0], low_b = lows_[1], high_a = highs_[0], high_b = highs_[1];
        const double from = first_across_, to = last_across_;
        for (int i = 0; i < at_once; ++i) {
            const double at = row + i;
            double low = low_a.at_zero + at * low_a.slope, high = high_a.at_zero + at * high_a.slope;
            const double other_low = low_b.at_zero + at * low_b.slope, other_high = high_b.at_zero + at * high_b.slope;
            low = low > other_low ? low : other_low;
            low = low > from ? low : from;
            low = low < to + 1 ? low : to + 1;
            high = high < other_high ? high : other_high;
            high = high < to ? high : to;
            high = high > from - 1 ? high : from - 1;
            ends.first[i] = -below(-low);
            ends.last[i] = below(high);
        }
    }

    int32_t first, last;

private:
    /** Line of a side: the square of a row that touches it. */
    struct Side {
        double at_zero, slope = 0;
    };

    /** Sets half planes: their intersection is the outline, or more where it is not convex. */
    void setSides(const PatchOutline& outline) {
        const auto& corners = outline.corners;
        const glm::dvec2 a = corners[2] - corners[0], b = corners[3] - corners[1];
        const double turn = a.x * b.y - a.y * b.x >= 0 ? 1 : -1;
        size_t lows = 0, highs = 0;
        for (size_t k = 0; k < 4; ++k) {
            const glm::dvec2 along = corners[(k + 1) % 4] - corners[k], out(turn * along.y, -turn * along.x);
            const double across = out[1 - axis_], up = out[axis_];
            std::array<Side, 2>& sides = across < 0 ? lows_ : highs_;
            size_t& count = across < 0 ? lows : highs;
            if (across == 0 || count == sides.size()) continue;
            double end = glm::dot(out, corners[0]);
            for (const glm::dvec2& corner : corners) end = std::max(end, glm::dot(out, corner));
            end += std::abs(out.x) * outline.margin.x + std::abs(out.y) * outline.margin.y - std::min(out.x, 0.0) -
                   std::min(out.y, 0.0);
            sides[count++] = {end / across, -up / across};
        }
    }

    int axis_;
    int32_t first_across_, last_across_;
    std::array<Side, 2> lows_{Side{-unbounded}, Side{-unbounded}}, highs_{Side{unbounded}, Side{unbounded}};
    static constexpr double unbounded = std::numeric_limits<double>::infinity();
};

/** Squares of a row. */
using SquaresAtOnce = int32_t __attribute__((vector_size(LatticeSquares::at_once * sizeof(int32_t))));
constexpr SquaresAtOnce upwards{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

double inverseRange(const Patch& patch, const glm::dvec3& direction) {
    return glm::dot(patch.normal, direction) / patch.distance;
}

PatchOutline makeOutline(const Patch& patch, const PatchLattice& lattice, const glm::dvec2& base, double spacing,
                         double near, double far) {
    const glm::dvec3 middle = patch.middle * lattice.range;
    const double per_spacing = 1 / spacing;
    const glm::dvec2 at = lattice.middle * per_spacing - base;
    // Sides of cones bend more than circles of elevation: no scatterer is lost in 930 random sonars with conical beams.
    const double bulge = (patch.width * patch.width + patch.height * patch.height) / (patch.conical ? 2 : 8);
    PatchOutline outline{{}, glm::dvec2(far * bulge * per_spacing)};
    std::array<int, 4> cut{};
    for (size_t i = 0; i < 4; ++i) {
        const double whole = 1 / std::max(inverseRange(patch, patch.corners[i]), 1e-9);
        const double range = std::clamp(whole, near, far);
        cut[i] = (range > whole ? 1 : 0) - (range < whole ? 1 : 0);
        outline.corners[i] = at + lattice.across(range * patch.corners[i] - middle) * per_spacing;
    }
    if (cut == std::array<int, 4>{}) return outline;
    // A corner that is cut off is outside the plane, by less than the patch's height, and width where its side is skew.
    const glm::dvec3 &to = patch.middle, up = glm::normalize(glm::dvec3(0, 0, 1) - to.z * to), aside(-to.y, to.x, 0);
    const double shift = patch.conical || cut[0] != cut[3] || cut[1] != cut[2] ? patch.width : 0;
    outline.margin +=
        far * per_spacing * (glm::abs(lattice.across(up)) * patch.height + glm::abs(lattice.across(aside)) * shift);
    return outline;
}

/** Returns the component in a direction of a point at `at`, and of u and v along their axes. */
LatticePatch::Plane makePlane(const glm::dvec3& direction, const glm::dvec3& at, const glm::dvec3& along_u,
                              const glm::dvec3& along_v) {
    const auto part = [&](const glm::dvec3& of) { return static_cast<float>(glm::dot(direction, of)); };
    return {part(at), part(along_u), part(along_v)};
}

/** Sets the edges of samples, and the sums of their beams. */
void setSamples(const EchoRules& rules, const Patch& patch, LatticePatch& part) {
    std::ranges::transform(patch.columns, part.columns, [](double edge) { return static_cast<float>(edge); });
    std::ranges::transform(patch.rows, part.rows, [](double edge) { return static_cast<float>(edge); });
    part.seen = patch.seen;
    const auto sums = static_cast<int32_t>(rules.sumCount());
    part.sum = static_cast<int32_t>(patch.beams[0]) * sums;
    for (size_t k = 0; k + 1 < Patch::max_columns; ++k)
        part.next_sums[k] = static_cast<int32_t>(patch.beams[k + 1] - patch.beams[k]) * sums;
}

LatticePatch getPart(const EchoRules& rules, const Patch& patch, const PatchLattice& lattice, const glm::dvec2& base,
                     const LatticeLevel& level) {
    const glm::dvec3 at = lattice.range * patch.middle, along_u = level.spacing * lattice.along[0],
                     along_v = level.spacing * lattice.along[1];
    LatticePatch part{};
    part.key = mixed(patch.number * 6 + lattice.side + mixed(level.number + 1));
    part.base_u = makeSquare(base.x);
    part.base_v = makeSquare(base.y);
    part.middle_u = static_cast<float>(lattice.middle.x / level.spacing - base.x);
    part.middle_v = static_cast<float>(lattice.middle.y / level.spacing - base.y);
    part.range = static_cast<float>(lattice.range);
    part.square_u = static_cast<float>(2 * glm::dot(at, along_u));
    part.square_v = static_cast<float>(2 * glm::dot(at, along_v));
    part.square_uu = static_cast<float>(glm::dot(along_u, along_u));
    part.square_uv = static_cast<float>(2 * glm::dot(along_u, along_v));
    part.square_vv = static_cast<float>(glm::dot(along_v, along_v));
    const AngularView::Direction towards = patch.conical ? AngularView::Direction{1, 0} : patch.bearing;
    part.height = makePlane({0, 0, 1}, at, along_u, along_v);
    part.aside = makePlane({-towards.sine, towards.cosine, 0}, at, along_u, along_v);
    part.front = patch.conical ? makePlane({1, 0, 0}, at, along_u, along_v) : LatticePatch::Plane{1, 0, 0};
    if (patch.conical)
        part.ahead_per_range = 1;
    else
        part.ahead = makePlane({towards.cosine, towards.sine, 0}, at, along_u, along_v);
    setSamples(rules, patch, part);
    const double turns = rules.turns_per_metre * lattice.range;
    part.turns = static_cast<float>(turns - std::floor(turns));
    part.turns_per_metre = static_cast<float>(rules.turns_per_metre);
    part.cells_per_metre = static_cast<float>(1 / rules.bins.bin_width);
    part.cell_count = static_cast<uint32_t>(rules.bins.bin_count);
    part.amplitude = static_cast<float>(rules.bins.bin_width * level.spacing *
                                        std::sqrt(patch.strength_range * patch.per_solid_angle * lattice.area_height));
    return part;
}

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

PatchLattice::PatchLattice(const Patch& patch, const LatticeFrame& frame) {
    const glm::dvec3 facing = patch.normal * frame.axes, size = glm::abs(facing);
    const int main = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    range = 1 / inverseRange(patch, patch.middle);
    side = static_cast<uint32_t>(2 * main + (facing[main] * patch.distance < 0 ? 1 : 0));
    for (int k = 0; k < 2; ++k) {
        const int i = (main + 1 + k) % 3;
        inverse[k] = &frame.inverse[i];
        along[k] = frame.axes[i] - facing[i] / facing[main] * frame.axes[main];
        middle[k] = frame.place[i] + range * glm::dot(frame.inverse[i], patch.middle);
    }
    // The cross product of both along the plane is its normal times volume / facing.
    area_height = frame.volume * std::abs(patch.distance / facing[main]);
}

/** Returns the slant ranges that a patch may reach: 1/r on a plane is a linear function of the direction. */
Scatterers::Ranges Scatterers::computeRanges(const Patch& patch) const {
    const double nearest_inverse = glm::length(patch.normal) / std::abs(patch.distance);
    const double bulge = nearest_inverse * (patch.width * patch.width + patch.height * patch.height) / 8;
    double low = inverseRange(patch, patch.middle), high = low;
    for (const glm::dvec3& corner : patch.corners) {
        const double inverse = inverseRange(patch, corner);
        low = std::min(low, inverse);
        high = std::max(high, inverse);
    }
    const double far_edge = rules_.edges[static_cast<size_t>(rules_.bins.bin_count)];
    return {1 / std::min({high + bulge, nearest_inverse, rules_.edges.front()}), 1 / std::max(low - bulge, far_edge)};
}

void Scatterers::deposit(const Patch& patch) {
    if (!(patch.strength_range > 0)) return;
    const Ranges all = computeRanges(patch);
    if (!(all.near < all.far)) return;
    if (frame_of_ != &patch.object) {
        frame_ = LatticeFrame(patch.object);
        frame_of_ = &patch.object;
    }
    const PatchLattice lattice(patch, frame_);
    double begin = 0;
    for (const LatticeLevel& level : rules_.lattice) {
        const Ranges here{std::max(all.near, begin), std::min(all.far, level.range_end)};
        begin = level.range_end;
        if (here.near < here.far) depositLevel(patch, lattice, level, here);
    }
}

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void Scatterers::depositLevel(const Patch& patch,
                                                                              const PatchLattice& lattice,
                                                                              const LatticeLevel& level,
                                                                              const Ranges& ranges) {
    const glm::dvec2 base = glm::floor(lattice.middle / level.spacing);
    LatticePatch part = getPart(rules_, patch, lattice, base, level);
    part.near_end = static_cast<float>(ranges.near - lattice.range);
    part.far_end = static_cast<float>(ranges.far - lattice.range);
    const OutlineRows rows(makeOutline(patch, lattice, base, level.spacing, ranges.near, ranges.far));
    int32_t* const across = rows.isAlong(1) ? squares_.u : squares_.v;
    int32_t* const up = rows.isAlong(1) ? squares_.v : squares_.u;
    OutlineRows::Ends ends;
    int count = 0;
    for (int32_t row = rows.first; row <= rows.last; ++row) {
        const int i = (row - rows.first) % OutlineRows::at_once;
        if (i == 0) rows.setEnds(row, ends);
        for (int32_t at = ends.first[i], last = ends.last[i]; at <= last; at += LatticeSquares::at_once) {
            if (count > LatticeSquares::capacity - LatticeSquares::at_once) {
                add(part, level, count);
                count = 0;
            }
            const SquaresAtOnce run = at + upwards, same = row + SquaresAtOnce{};
            std::memcpy(across + count, &run, sizeof run);
            std::memcpy(up + count, &same, sizeof same);
            count += std::min(last - at + 1, LatticeSquares::at_once);
        }
    }
    add(part, level, count);
}

void Scatterers::add(const LatticePatch& part, const LatticeLevel& level, int count) {
    const auto wholeVectors = [](int n) { return (n + LatticeSquares::at_once - 1) & ~(LatticeSquares::at_once - 1); };
    place(part, squares_, wholeVectors(count), scatterers_);
    locate(part, wholeVectors(count), scatterers_);
    const int held = keepHeld(count, scatterers_);
    for (int i = 0; level.represents > 0 && i < held; ++i)
        scatterers_.size[i] *=
            std::sqrt(gammaStrength(static_cast<float>(level.represents), mixed(scatterers_.bits[i] + 0x5bd1e995u)));
    radiate(wholeVectors(held), scatterers_);
    countQuanta(scatterers_.real, wholeVectors(held), scatterers_.real_quanta);
    countQuanta(scatterers_.imaginary, wholeVectors(held), scatterers_.imaginary_quanta);
    for (int i = 0; i < held; ++i) {
        uint64_t* const sums = sums_ + scatterers_.sum[i];
        sums[0] += static_cast<uint64_t>(scatterers_.real_quanta[i]);
        sums[1] += static_cast<uint64_t>(scatterers_.imaginary_quanta[i]);
    }
}

}  // namespace insonify::sonar
