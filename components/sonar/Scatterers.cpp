#include "components/sonar/Scatterers.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "types/VectorMath.hpp"

namespace insonify::sonar {

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

/** A patch in the coordinates of the lattice of its object: its own axes, in metres. `column`: of the two axes along
 *  which the lattice is, and of the one that the patch faces most. */
struct PatchLattice {
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

namespace {

/** A fixed 32-bit integer hash (C. Wellons' lowbias32). */
uint32_t mixed(uint32_t x) {
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

/** To the nearest whole number, for less than 2^22, without a call. */
float nearest(float x) { return (x + 12582912.0f) - 12582912.0f; }

/** A uniform number in (0, 1) of 16 bits. */
float uniform(uint32_t bits) { return (static_cast<float>(static_cast<int32_t>(bits & 0xffffu)) + 0.5f) * 0x1p-16f; }

float logarithm(float x) {
    const types::PowersOfTwo parts = types::split(x);
    return types::log1pSmall(parts.rest) + 0.693147181f * static_cast<float>(parts.powers);
}

/** Sine and cosine of turns within [-1/2, 1/2]; polynomials at Chebyshev's points, within 1e-6. */
float sineOf(float turns) {
    const float s = turns * turns;
    float sum = 3.19933885f;
    sum = sum * s + -14.8683228f;
    sum = sum * s + 42.0160758f;
    sum = sum * s + -76.7015377f;
    sum = sum * s + 81.6050236f;
    sum = sum * s + -41.341697f;
    return turns * (sum * s + 6.28318527f);
}
float cosineOf(float turns) {
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
float gammaPower(float merged, uint32_t bits) {
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

INSONIFY_VECTOR_CLONES void scatter(const LatticePatch& patch, const LatticeSquares& squares,
                                    ScatteredFields& __restrict fields) {
    const LatticePatch p = patch;
    const int count = (squares.count + 15) & ~15;  // no rest that is not a whole vector
    for (int i = 0; i < count; ++i) {
        const uint32_t place = mixed(mixed(static_cast<uint32_t>(p.base_u + squares.u[i]) + p.key) +
                                     static_cast<uint32_t>(p.base_v + squares.v[i]));
        const uint32_t power = mixed(place + 0x632be5abu);
        const float on_u = static_cast<float>(squares.u[i]) + uniform(place) - p.middle_u;
        const float on_v = static_cast<float>(squares.v[i]) + uniform(place >> 16) - p.middle_v;
        const float x = on_u * p.along_u[0] + on_v * p.along_v[0], y = on_u * p.along_u[1] + on_v * p.along_v[1],
                    z = on_u * p.along_u[2] + on_v * p.along_v[2];
        const float change = 2 * (p.at[0] * x + p.at[1] * y + p.at[2] * z) + (x * x + y * y + z * z);
        const float square = p.range * p.range + change;
        const float range = std::sqrt(square > 1e-12f ? square : 1e-12f);
        const float further = change / (p.range + range), per_range = 1 / range;
        const float sine = (p.at[2] + z) * per_range;
        const float past_low = p.low[0] * x + p.low[1] * y + p.low_at - p.low_cone * range;
        const float past_high = p.high[0] * x + p.high[1] * y + p.high_at - p.high_cone * range;
        const float cells = (further + p.cell_offset) * p.cells_per_metre;
        const auto whole = static_cast<int32_t>(cells);
        const int32_t cell = p.first_cell + whole - (cells < static_cast<float>(whole) ? 1 : 0);
        const int inside = (sine >= p.low_sine) & (sine < p.high_sine) & (further >= p.near_end) &
                           (further < p.far_end) & (past_low >= 0) & (past_high < 0) & (cell >= 0) &
                           (cell < p.cell_count);
        const float middle = (static_cast<float>(cell) + 0.5f) * p.cell_width;
        const float field =
            p.amplitude * std::sqrt(-logarithm(uniform(power))) * per_range * per_range * per_range * middle;
        const float phase = p.turns + p.turns_per_metre * further + uniform(power >> 16);
        const float turns = phase - nearest(phase);
        fields.real[i] = field * cosineOf(turns);
        fields.imaginary[i] = field * sineOf(turns);
        fields.cell[i] = inside != 0 ? cell : -1;
        fields.bits[i] = place;
    }
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

PatchOutline::Span PatchOutline::inRow(int axis, double row) const {
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

double inverseRange(const Patch& patch, const glm::dvec3& direction) {
    return glm::dot(patch.normal, direction) / patch.distance;
}

/** How a point lies past a bearing: past.d + from - cone * range [1, m, 1]. */
void setBearing(bool conical, double bearing, const glm::dvec3& at, float* past, float& from, float& cone) {
    const double sine = std::sin(bearing), cosine = std::cos(bearing);
    past[0] = static_cast<float>(conical ? 0 : -sine);
    past[1] = static_cast<float>(conical ? 1 : cosine);
    from = static_cast<float>(conical ? at.y : cosine * at.y - sine * at.x);
    cone = static_cast<float>(conical ? sine : 0);
}

PatchOutline outlineOf(const Patch& patch, const PatchLattice& lattice, double spacing, double near, double far) {
    const glm::dvec3 middle = patch.middle / inverseRange(patch, patch.middle);
    const glm::dvec2 base = glm::floor(lattice.middle / spacing), at = lattice.middle / spacing - base;
    PatchOutline outline{{}, glm::dvec2(far * patch.width * patch.width / (8 * spacing))};
    bool is_cut = false;
    for (size_t i = 0; i < 4; ++i) {
        const double inverse = inverseRange(patch, patch.corners[i]);
        const double range = std::clamp(1 / std::max(inverse, 1e-9), near, far);
        is_cut = is_cut || !(range * inverse > 0.999999);
        outline.corners[i] = at + lattice.across(range * patch.corners[i] - middle) / spacing;
    }
    // A corner that is cut off is off the plane, by less than the patch is high.
    const glm::dvec3 up = glm::normalize(glm::dvec3(0, 0, 1) - patch.middle.z * patch.middle);
    if (is_cut) outline.margin += glm::abs(lattice.across(up)) * (far * patch.height / spacing);
    return outline;
}

/** The phase of the middle of a patch, and the range cell that it is in. */
void setRange(const EchoRules& rules, double range, LatticePatch& part) {
    const double width = rules.bins.bin_width, turns = rules.turns_per_metre * range, cell = std::floor(range / width);
    part.range = static_cast<float>(range);
    part.turns = static_cast<float>(turns - std::floor(turns));
    part.turns_per_metre = static_cast<float>(rules.turns_per_metre);
    part.cell_offset = static_cast<float>(range - cell * width);
    part.cells_per_metre = static_cast<float>(1 / width);
    part.cell_width = static_cast<float>(width);
    part.first_cell = static_cast<int32_t>(cell);
    part.cell_count = static_cast<int32_t>(rules.bins.bin_count);
}

LatticePatch partOf(const EchoRules& rules, const Patch& patch, const PatchLattice& lattice,
                    const LatticeLevel& level) {
    const double range = 1 / inverseRange(patch, patch.middle);
    const glm::dvec3 at = range * patch.middle;
    const glm::dvec2 place = lattice.middle / level.spacing, base = glm::floor(place);
    const double perpendicular = std::abs(patch.distance) / glm::length(patch.normal);
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
    setRange(rules, range, part);
    setBearing(patch.conical, patch.low_bearing, at, part.low, part.low_at, part.low_cone);
    setBearing(patch.conical, patch.high_bearing, at, part.high, part.high_at, part.high_cone);
    part.low_sine = static_cast<float>(patch.low_sine);
    part.high_sine = static_cast<float>(patch.high_sine);
    part.amplitude = static_cast<float>(
        level.spacing * std::sqrt(patch.strength_range * patch.per_solid_angle * lattice.area * perpendicular));
    return part;
}

uint64_t signedQuanta(float field) {
    return static_cast<uint64_t>(static_cast<int64_t>(static_cast<double>(field) * quanta_per_unit));
}

}  // namespace

PatchLattice::PatchLattice(const Patch& patch) {
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

/** Those that a patch may reach: 1/r on a plane is a linear function of the direction. */
Scatterers::Ranges Scatterers::rangesOf(const Patch& patch) const {
    const double nearest_inverse = glm::length(patch.normal) / std::abs(patch.distance);
    const double bulge = nearest_inverse * (patch.width * patch.width + patch.height * patch.height) / 8;
    double low = inverseRange(patch, patch.middle), high = low;
    for (const glm::dvec3& corner : patch.corners) {
        low = std::min(low, inverseRange(patch, corner));
        high = std::max(high, inverseRange(patch, corner));
    }
    const double far_edge = rules_.edges[static_cast<size_t>(rules_.bins.bin_count)];
    return {1 / std::min({high + bulge, nearest_inverse, rules_.edges.front()}), 1 / std::max(low - bulge, far_edge)};
}

void Scatterers::deposit(const Patch& patch, size_t beam) {
    if (!(patch.strength_range > 0)) return;
    const PatchLattice lattice(patch);
    const Ranges all = rangesOf(patch);
    double begin = 0;
    for (const LatticeLevel& level : rules_.lattice) {
        const Ranges here{std::max(all.near, begin), std::min(all.far, level.range_end)};
        begin = level.range_end;
        if (here.near < here.far) depositLevel(patch, lattice, level, here, sums_ + beam * rules_.sumCount());
    }
}

void Scatterers::depositLevel(const Patch& patch, const PatchLattice& lattice, const LatticeLevel& level,
                              const Ranges& ranges, uint64_t* of_beam) {
    LatticePatch part = partOf(rules_, patch, lattice, level);
    part.near_end = static_cast<float>(ranges.near - 1 / inverseRange(patch, patch.middle));
    part.far_end = static_cast<float>(ranges.far - 1 / inverseRange(patch, patch.middle));
    const PatchOutline outline = outlineOf(patch, lattice, level.spacing, ranges.near, ranges.far);
    const PatchOutline::Span u = outline.extent(0), v = outline.extent(1);
    const int axis = v.high - v.low <= u.high - u.low ? 1 : 0;
    const PatchOutline::Span rows = axis == 1 ? v : u;
    for (double row = std::floor(rows.low); row <= rows.high; ++row) {
        const PatchOutline::Span span = outline.inRow(axis, row);
        for (double at = std::floor(span.low); at <= span.high; ++at) {
            squares_.u[squares_.count] = static_cast<int32_t>(axis == 1 ? at : row);
            squares_.v[squares_.count] = static_cast<int32_t>(axis == 1 ? row : at);
            if (++squares_.count == LatticeSquares::most) add(part, level, of_beam);
        }
    }
    add(part, level, of_beam);
}

void Scatterers::add(const LatticePatch& part, const LatticeLevel& level, uint64_t* of_beam) {
    scatter(part, squares_, fields_);
    for (int i = 0; i < squares_.count; ++i) {
        if (fields_.cell[i] < 0) continue;
        float root = 1;
        if (level.merged > 0)
            root = std::sqrt(gammaPower(static_cast<float>(level.merged), fields_.bits[i] ^ 0x5bd1e995u));
        uint64_t* const cell = of_beam + 2 * fields_.cell[i];
        cell[0] += signedQuanta(root * fields_.real[i]);
        cell[1] += signedQuanta(root * fields_.imaginary[i]);
    }
    squares_.count = 0;
}

}  // namespace insonify::sonar
