#pragma once
// The estimator of fields: which scatterers lie on what samples see, and what they add to the field of each range cell.
// To be included by what deposits rays alone, after Estimators.hpp.
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "components/sonar/Estimators.hpp"

namespace insonify::sonar {
namespace {

/** A part of a triangle's plane that neighbouring samples see; sonar axes. */
struct Patch {
    glm::dvec3 normal;                  ///< Of any length [1].
    double distance;                    ///< normal.p of its points [m].
    glm::dvec3 middle;                  ///< Unit, to its middle [1].
    std::array<glm::dvec3, 4> corners;  ///< Unit, to its corners [1].
    double low_bearing, high_bearing;   ///< [rad]
    double low_sine, high_sine;         ///< Of its elevations [1].
    double width, height;               ///< [rad]
    double strength_range;              ///< Strength times slant range [m].
    double per_solid_angle;             ///< Two-way pattern in elevation, over the solid angle of a cell [1/sr].
    const ObjectRecord& object;
    uint32_t number;  ///< Of the object [1].
};

/** A fixed 32-bit integer hash (C. Wellons' lowbias32). */
inline uint32_t mixed(uint32_t x) {
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

/** To the nearest whole number, for less than 2^22, without a call. */
inline float nearest(float x) { return (x + 12582912.0f) - 12582912.0f; }

/** A uniform number in (0, 1) of 16 bits. */
inline float uniform(uint32_t bits) {
    return (static_cast<float>(static_cast<int32_t>(bits & 0xffffu)) + 0.5f) * 0x1p-16f;
}

inline float logarithm(float x) {
    const types::PowersOfTwo parts = types::split(x);
    return types::log1pSmall(parts.rest) + 0.693147181f * static_cast<float>(parts.powers);
}

/** Sine and cosine of turns within [-1/2, 1/2]; polynomials at Chebyshev's points, within 1e-6. */
inline float sineOf(float turns) {
    const float s = turns * turns;
    float sum = 3.19933885f;
    sum = sum * s + -14.8683228f;
    sum = sum * s + 42.0160758f;
    sum = sum * s + -76.7015377f;
    sum = sum * s + 81.6050236f;
    sum = sum * s + -41.341697f;
    return turns * (sum * s + 6.28318527f);
}
inline float cosineOf(float turns) {
    const float s = turns * turns;
    float sum = 6.52865816f;
    sum = sum * s + -25.9675992f;
    sum = sum * s + 60.167631f;
    sum = sum * s + -85.4501395f;
    sum = sum * s + 64.9391175f;
    sum = sum * s + -19.7392045f;
    return sum * s + 0.999999989f;
}

/** Power of one scatterer of the lattice that stands for `merged` of exponentially distributed strength, as one draws
 *  it [mean 1]: Gamma(merged), by its sum, or by Wilson and Hilferty's cube. */
inline float gammaPower(float merged, uint32_t bits) {
    if (merged <= 4) {
        float sum = 0;
        for (float i = 0; i < merged; ++i, bits = mixed(bits + 0x9e3779b9u)) sum -= logarithm(uniform(bits));
        return sum / merged;
    }
    const float radius = std::sqrt(-2 * logarithm(uniform(bits >> 16)));
    const float normal = radius * cosineOf(uniform(bits) - 0.5f);
    const float root = std::max(0.0f, 1 - 1 / (9 * merged) + normal / (3 * std::sqrt(merged)));
    return root * root * root;
}

/** Squares of the lattice in which scatterers of a patch may be, from the square that holds its middle. */
struct LatticeSquares {
    static constexpr int most = 256;
    alignas(64) int32_t u[most], v[most];
    int count = 0;
};

/** What they add: the field in units of the square root of a whole cell, and to which range cell; -1: none. */
struct ScatteredFields {
    alignas(64) float real[LatticeSquares::most], imaginary[LatticeSquares::most];
    alignas(64) int32_t cell[LatticeSquares::most];
    alignas(64) uint32_t bits[LatticeSquares::most];
};

/** What is the same for all scatterers of a patch on one lattice, about its middle. */
struct LatticePatch {
    uint32_t key;
    int32_t base_u, base_v;                  ///< The square of the middle.
    float middle_u, middle_v;                ///< Where it lies in that [spacings].
    float along_u[3], along_v[3];            ///< A spacing further on the plane [m].
    float at[3], range;                      ///< The middle [m].
    float low[3], low_at, high[3], high_at;  ///< Distances from the planes of its bearings: low.d + low_at >= 0 [1, m].
    float low_sine, high_sine;               ///< Of elevation, or of the bearing of cones [1].
    float low_cone, high_cone;
    float near_end, far_end;       ///< Slant ranges, from the middle's [m].
    float amplitude;               ///< Times the square root of a power over the square of the range.
    float turns, turns_per_metre;  ///< Phase of the middle, two way.
    float cell_offset, cells_per_metre, cell_width;
    int32_t first_cell, cell_count;
};

template <bool conical>
inline void scatter(const LatticePatch& p, const LatticeSquares& squares, ScatteredFields& __restrict fields) {
    for (int i = 0; i < squares.count; ++i) {
        const auto u = static_cast<uint32_t>(p.base_u + squares.u[i]),
                   v = static_cast<uint32_t>(p.base_v + squares.v[i]);
        const uint32_t place = mixed(mixed(u + p.key) + v), power = mixed(place + 0x632be5abu);
        const float on_u = static_cast<float>(squares.u[i]) + uniform(place) - p.middle_u;
        const float on_v = static_cast<float>(squares.v[i]) + uniform(place >> 16) - p.middle_v;
        const float x = on_u * p.along_u[0] + on_v * p.along_v[0], y = on_u * p.along_u[1] + on_v * p.along_v[1],
                    z = on_u * p.along_u[2] + on_v * p.along_v[2];
        const float change = 2 * (p.at[0] * x + p.at[1] * y + p.at[2] * z) + (x * x + y * y + z * z);
        const float range = std::sqrt(std::max(p.range * p.range + change, 1e-12f));
        const float further = change / (p.range + range), per_range = 1 / range;
        const float sine = (p.at[2] + z) * per_range;
        bool inside = sine >= p.low_sine && sine < p.high_sine && further >= p.near_end && further < p.far_end;
        if constexpr (conical) {
            const float cone = (p.at[1] + y) * per_range;
            inside = inside && cone >= p.low_cone && cone < p.high_cone;
        } else {
            inside = inside && p.low[0] * x + p.low[1] * y + p.low[2] * z + p.low_at >= 0 &&
                     p.high[0] * x + p.high[1] * y + p.high[2] * z + p.high_at < 0;
        }
        const float cells = (further + p.cell_offset) * p.cells_per_metre;
        const auto whole = static_cast<int32_t>(cells);
        const int32_t cell = p.first_cell + whole - (cells < static_cast<float>(whole) ? 1 : 0);
        inside = inside && cell >= 0 && cell < p.cell_count;
        const float middle = (static_cast<float>(cell) + 0.5f) * p.cell_width;
        const float field =
            p.amplitude * std::sqrt(-logarithm(uniform(power))) * per_range * per_range * per_range * middle;
        const float phase = p.turns + p.turns_per_metre * further + uniform(power >> 16);
        const float turns = phase - nearest(phase);
        fields.real[i] = field * cosineOf(turns);
        fields.imaginary[i] = field * sineOf(turns);
        fields.cell[i] = inside ? cell : -1;
        fields.bits[i] = place;
    }
}

/** A patch in the coordinates of the lattice of its object: its own axes, in metres. `column`: of the two axes along
 *  which the lattice is, and of the one that the patch faces most. */
class PatchLattice {
public:
    explicit PatchLattice(const Patch& patch);

    /** From the middle, which is `range` away, to a point: along the two axes [m]. */
    glm::dvec2 across(const glm::dvec3& from_middle) const {
        return {glm::dot(inverse_[0], from_middle), glm::dot(inverse_[1], from_middle)};
    }
    glm::dvec3 along[2];  ///< On the plane, a metre further along each [m].
    glm::dvec2 middle;    ///< Where the patch's middle is [m].
    uint32_t side;        ///< The axis that the patch faces, and whether from behind: 0 to 5.
    double area;          ///< Of the plane over a square metre of the lattice [1].

private:
    glm::dvec3 inverse_[2];
};

inline PatchLattice::PatchLattice(const Patch& patch) {
    const ObjectRecord& object = patch.object;
    glm::dvec3 axis[3], inverse[3], at;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 column(object.row_x[i], object.row_y[i], object.row_z[i]);
        const double scale = glm::length(column);
        axis[i] = column / scale;
        inverse[i] = scale * glm::dvec3(object.normal_x[i], object.normal_y[i], object.normal_z[i]);
        at[i] = scale * (double{object.eye[i]} + double{object.eye_rest[i]});
    }
    const glm::dvec3 facing(glm::dot(axis[0], patch.normal), glm::dot(axis[1], patch.normal),
                            glm::dot(axis[2], patch.normal));
    const glm::dvec3 size = glm::abs(facing);
    const int main = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const glm::dvec3 to_middle = patch.middle * (patch.distance / glm::dot(patch.normal, patch.middle));
    side = static_cast<uint32_t>(2 * main + (facing[main] * patch.distance < 0 ? 1 : 0));
    for (int k = 0; k < 2; ++k) {
        const int i = (main + 1 + k) % 3;
        inverse_[k] = inverse[i];
        along[k] = axis[i] - facing[i] / facing[main] * axis[main];
        middle[k] = at[i] + glm::dot(inverse[i], to_middle);
    }
    area = glm::length(glm::cross(along[0], along[1]));
}

/** The outline of a patch on its lattice, from the square that holds its middle [spacings]. */
struct PatchOutline {
    std::array<glm::dvec2, 4> corners;
    glm::dvec2 margin;  ///< It may be so much larger, for its sides are bent.

    struct Span {
        double low, high;
    };
    Span extent(int axis) const {
        Span span{corners[0][axis], corners[0][axis]};
        for (const glm::dvec2& corner : corners)
            span = {std::min(span.low, corner[axis]), std::max(span.high, corner[axis])};
        return {span.low - margin[axis], span.high + margin[axis]};
    }
    /** Of what lies in one row of squares; `axis` counts the rows. */
    Span inRow(int axis, double row) const;
};

inline PatchOutline::Span PatchOutline::inRow(int axis, double row) const {
    const double from = row - margin[axis], to = row + 1 + margin[axis];
    Span span{1, 0};
    bool any = false;
    for (size_t k = 0; k < corners.size(); ++k) {
        const glm::dvec2 a = corners[k], b = corners[(k + 1) % corners.size()];
        const double rise = b[axis] - a[axis];
        double enters = 0, leaves = 1;
        if (rise != 0) {
            const double first = (from - a[axis]) / rise, second = (to - a[axis]) / rise;
            enters = std::max(0.0, std::min(first, second));
            leaves = std::min(1.0, std::max(first, second));
        }
        if (enters > leaves || std::max(a[axis], b[axis]) < from || std::min(a[axis], b[axis]) > to) continue;
        for (const double share : {enters, leaves}) {
            const double at = a[1 - axis] + share * (b[1 - axis] - a[1 - axis]);
            span = any ? Span{std::min(span.low, at), std::max(span.high, at)} : Span{at, at};
            any = true;
        }
    }
    return {span.low - margin[1 - axis], span.high + margin[1 - axis]};
}

/** Fields of scatterers: [beam][range cell][real, imaginary] in quanta, with sign. */
class PhasorBins : public Bins {
public:
    static constexpr bool tells_truth = false;
    static constexpr Features features{Feature::Physical, Feature::Speckle};

    PhasorBins(const EchoRules& rules, uint64_t* all_sums, const TruthSink*) : Bins(rules, all_sums), rules_(rules) {}

    template <bool conical>
    void depositPatch(const Patch& patch, uint beam) {
        if (!(patch.strength_range > 0)) return;
        const PatchLattice lattice(patch);
        const Ranges all = rangesOf(patch);
        double begin = 0;
        for (const LatticeLevel& level : rules_.lattice) {
            const Ranges here{std::max(all.near, begin), std::min(all.far, level.range_end)};
            begin = level.range_end;
            if (here.near < here.far) depositLevel<conical>(patch, lattice, level, here, sums + beam * beam_sums);
        }
    }

private:
    /** Slant ranges [m]. */
    struct Ranges {
        double near, far;
    };

    static double inverseRange(const Patch& patch, const glm::dvec3& direction) {
        return glm::dot(patch.normal, direction) / patch.distance;
    }
    /** Those that a patch may reach: 1/r is a plane's linear function of the direction. */
    Ranges rangesOf(const Patch& patch) const {
        const double nearest_inverse = glm::length(patch.normal) / std::abs(patch.distance);
        const double bulge = nearest_inverse * (patch.width * patch.width + patch.height * patch.height) / 8;
        double low = inverseRange(patch, patch.middle), high = low;
        for (const glm::dvec3& corner : patch.corners) {
            low = std::min(low, inverseRange(patch, corner));
            high = std::max(high, inverseRange(patch, corner));
        }
        return {1 / std::min({high + bulge, nearest_inverse, edges[0]}), 1 / std::max(low - bulge, edges[bin_count])};
    }

    template <bool conical>
    void depositLevel(const Patch& patch, const PatchLattice& lattice, const LatticeLevel& level, const Ranges& ranges,
                      uint64_t* of_beam) {
        const LatticePatch part = partOf(patch, lattice, level, ranges);
        const PatchOutline outline = outlineOf(patch, lattice, level.spacing, ranges);
        const PatchOutline::Span u = outline.extent(0), v = outline.extent(1);
        const int axis = v.high - v.low <= u.high - u.low ? 1 : 0;
        const PatchOutline::Span rows = axis == 1 ? v : u;
        for (double row = std::floor(rows.low); row <= rows.high; ++row) {
            const PatchOutline::Span span = outline.inRow(axis, row);
            for (double at = std::floor(span.low); at <= span.high; ++at) {
                squares_.u[squares_.count] = static_cast<int32_t>(axis == 1 ? at : row);
                squares_.v[squares_.count] = static_cast<int32_t>(axis == 1 ? row : at);
                if (++squares_.count == LatticeSquares::most) add<conical>(part, level, of_beam);
            }
        }
        add<conical>(part, level, of_beam);
    }

    PatchOutline outlineOf(const Patch& patch, const PatchLattice& lattice, double spacing,
                           const Ranges& ranges) const {
        const glm::dvec3 middle = patch.middle / inverseRange(patch, patch.middle);
        const glm::dvec2 base = glm::floor(lattice.middle / spacing), at = lattice.middle / spacing - base;
        PatchOutline outline{{}, glm::dvec2(ranges.far * patch.width * patch.width / (8 * spacing))};
        bool is_cut = false;
        for (size_t i = 0; i < 4; ++i) {
            const double inverse = inverseRange(patch, patch.corners[i]);
            const double range = std::clamp(1 / std::max(inverse, edges[bin_count]), ranges.near, ranges.far);
            is_cut = is_cut || range * inverse != 1;
            outline.corners[i] = at + lattice.across(range * patch.corners[i] - middle) / spacing;
        }
        // A corner that is cut off is off the plane, by less than the patch is high.
        const glm::dvec3 up = glm::normalize(glm::dvec3(0, 0, 1) - patch.middle.z * patch.middle);
        if (is_cut) outline.margin += glm::abs(lattice.across(up)) * (ranges.far * patch.height / spacing);
        return outline;
    }

    LatticePatch partOf(const Patch& patch, const PatchLattice& lattice, const LatticeLevel& level,
                        const Ranges& ranges) const {
        const double range = 1 / inverseRange(patch, patch.middle);
        const glm::dvec3 at = range * patch.middle;
        const glm::dvec2 place = lattice.middle / level.spacing, base = glm::floor(place);
        const double perpendicular = std::abs(patch.distance) / glm::length(patch.normal);
        const double turns = rules_.turns_per_metre * range, cell = std::floor(range / bin_width);
        LatticePatch part{};
        part.key = mixed(patch.number * 6 + lattice.side + mixed(level.number + 1));
        part.base_u = static_cast<int32_t>(static_cast<int64_t>(base.x));
        part.base_v = static_cast<int32_t>(static_cast<int64_t>(base.y));
        part.middle_u = static_cast<float>(place.x - base.x);
        part.middle_v = static_cast<float>(place.y - base.y);
        for (int i = 0; i < 3; ++i) {
            part.along_u[i] = static_cast<float>(level.spacing * lattice.along[0][i]);
            part.along_v[i] = static_cast<float>(level.spacing * lattice.along[1][i]);
            part.at[i] = static_cast<float>(at[i]);
        }
        part.range = static_cast<float>(range);
        setBearings(patch, at, part);
        part.low_sine = static_cast<float>(patch.low_sine);
        part.high_sine = static_cast<float>(patch.high_sine);
        part.near_end = static_cast<float>(ranges.near - range);
        part.far_end = static_cast<float>(ranges.far - range);
        part.amplitude = static_cast<float>(
            level.spacing * std::sqrt(patch.strength_range * patch.per_solid_angle * lattice.area * perpendicular));
        part.turns = static_cast<float>(turns - std::floor(turns));
        part.turns_per_metre = static_cast<float>(rules_.turns_per_metre);
        part.cell_offset = static_cast<float>(range - cell * bin_width);
        part.cells_per_metre = static_cast<float>(1 / bin_width);
        part.cell_width = static_cast<float>(bin_width);
        part.first_cell = static_cast<int32_t>(cell);
        part.cell_count = static_cast<int32_t>(bin_count);
        return part;
    }

    static void setBearings(const Patch& patch, const glm::dvec3& at, LatticePatch& part) {
        const auto plane = [&](double bearing, float* normal, float& from) {
            const double sine = std::sin(bearing), cosine = std::cos(bearing);
            normal[0] = static_cast<float>(-sine);
            normal[1] = static_cast<float>(cosine);
            from = static_cast<float>(cosine * at.y - sine * at.x);
            return static_cast<float>(sine);
        };
        part.low_cone = plane(patch.low_bearing, part.low, part.low_at);
        part.high_cone = plane(patch.high_bearing, part.high, part.high_at);
    }

    template <bool conical>
    void add(const LatticePatch& part, const LatticeLevel& level, uint64_t* of_beam) {
        scatter<conical>(part, squares_, fields_);
        for (int i = 0; i < squares_.count; ++i) {
            if (fields_.cell[i] < 0) continue;
            const float root =
                level.merged > 0
                    ? std::sqrt(gammaPower(static_cast<float>(level.merged), fields_.bits[i] ^ 0x5bd1e995u))
                    : 1;
            uint64_t* const cell = of_beam + 2 * fields_.cell[i];
            cell[0] += signedQuanta(root * fields_.real[i]);
            cell[1] += signedQuanta(root * fields_.imaginary[i]);
        }
        squares_.count = 0;
    }
    static uint64_t signedQuanta(float field) {
        return static_cast<uint64_t>(static_cast<int64_t>(static_cast<double>(field) * quanta_per_unit));
    }

    const EchoRules& rules_;
    LatticeSquares squares_;
    ScatteredFields fields_;
};

}  // namespace
}  // namespace insonify::sonar
