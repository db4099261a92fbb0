#include "components/sonar/field/Scatterers.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "components/sonar/field/RandomFields.hpp"
#include "types/VectorMath.hpp"

namespace insonify::sonar {

/** What is the same for all scatterers of a patch on one lattice, about its middle. */
struct LatticePatch {
    uint32_t key, base_u, base_v;       ///< The square of the middle.
    float middle_u, middle_v;           ///< Where it lies in that [spacings].
    float along_u[3], along_v[3];       ///< A spacing further on the plane [m].
    float at[3], range;                 ///< The middle [m].
    float low[2], low_at, low_cone;     ///< Past its lower bearing: low.d + low_at - low_cone range >= 0 [1, m, 1].
    float high[2], high_at, high_cone;  ///< The same of the upper one,
    float next[3][2], next_at[3], next_cone[3];  ///< and of those between beams.
    float low_sine, high_sine;                   ///< Of elevation [1].
    float near_end, far_end;                     ///< Slant ranges, from the middle's [m].
    float amplitude;                             ///< Times the square root of a power over the square of the range.
    float turns, turns_per_metre;                ///< Phase of the middle, two way.
    float cell_offset, cells_per_metre, cell_width;
    int32_t first_cell, cell_count;
};

/** A patch in the coordinates of the lattice of its object: two of the object's axes, in metres. */
struct PatchLattice {
    PatchLattice(const Patch& patch, const LatticeFrame& frame);

    /** From the middle to a point: along the two axes [m]. */
    glm::dvec2 across(const glm::dvec3& from_middle) const {
        return {glm::dot(*inverse[0], from_middle), glm::dot(*inverse[1], from_middle)};
    }
    const glm::dvec3* inverse[2];
    glm::dvec3 along[2];  ///< On the plane, a metre further along each [m].
    glm::dvec2 middle;    ///< Where the patch's middle is [m].
    double range;         ///< Of the middle [m].
    uint32_t side;        ///< The axis that the patch faces most, and whether from behind: 0 to 5.
    double area_height;   ///< Of the plane over a square metre of the lattice, times its distance from the sonar [m].
};

namespace {

/** Strength of what one scatterer of the lattice stands for, over its mean: Gamma(shape), as the total of so many
 *  scatterers of exponentially distributed strength is, by Wilson and Hilferty's cube for shape + 1 (1931) and the
 *  power of a uniform number that leads from there to `shape`. */
float gammaStrength(float shape, uint32_t bits) {
    const float next = shape + 1;
    const float normal = std::sqrt(-2 * logarithm(uniform(bits >> 16))) * cosineOf(uniform(bits) - 0.5f);
    const float root = std::max(0.0f, 1 - 1 / (9 * next) + normal / (3 * std::sqrt(next)));
    const float chance = uniform(mixed(bits + 0x9e3779b9u));
    return next / shape * root * root * root * std::exp(logarithm(chance) / shape);
}

INSONIFY_VECTOR_CLONES void scatter(const LatticePatch& patch, const LatticeSquares& squares, int count,
                                    ScatteredFields& __restrict fields) {
    const LatticePatch p = patch;
    const int whole_vectors = (count + 15) & ~15;
    for (int i = 0; i < whole_vectors; ++i) {
        const uint32_t place = mixed(mixed(p.base_u + static_cast<uint32_t>(squares.u[i]) + p.key) + p.base_v +
                                     static_cast<uint32_t>(squares.v[i]));
        const uint32_t power = mixed(place + 0x632be5abu);
        const float on_u = static_cast<float>(squares.u[i]) + uniform(place) - p.middle_u;
        const float on_v = static_cast<float>(squares.v[i]) + uniform(place >> 16) - p.middle_v;
        const float x = on_u * p.along_u[0] + on_v * p.along_v[0], y = on_u * p.along_u[1] + on_v * p.along_v[1],
                    z = on_u * p.along_u[2] + on_v * p.along_v[2];
        const float change = 2 * (p.at[0] * x + p.at[1] * y + p.at[2] * z) + (x * x + y * y + z * z);
        const float square = p.range * p.range + change;
        const float range = std::sqrt(square > 1e-12f ? square : 1e-12f), sum = p.range + range;
        const float per_both = 1 / (range * sum);  // one division for two
        const float further = change * per_both * range, per_range = per_both * sum;
        const float past_low = p.low[0] * x + p.low[1] * y + p.low_at - p.low_cone * range;
        const float past_high = p.high[0] * x + p.high[1] * y + p.high_at - p.high_cone * range;
        const float height = p.at[2] + z;
        const float cells = (further + p.cell_offset) * p.cells_per_metre;
        const auto whole = static_cast<int32_t>(cells);
        const int32_t cell = p.first_cell + whole - (cells < static_cast<float>(whole) ? 1 : 0);
        const int inside = (height >= p.low_sine * range) & (height < p.high_sine * range) & (further >= p.near_end) &
                           (further < p.far_end) & (past_low >= 0) & (past_high < 0) & (cell >= 0) &
                           (cell < p.cell_count);
        const float middle = (static_cast<float>(cell) + 0.5f) * p.cell_width;
        const float whole_field =
            p.amplitude * std::sqrt(-logarithm(uniform(power))) * per_range * per_range * per_range * middle;
        const float field = inside != 0 ? whole_field : 0.0f;
        const float phase = p.turns + p.turns_per_metre * further + uniform(power >> 16);
        const float turns = phase - nearest(phase);
        fields.real[i] = field * cosineOf(turns);
        fields.imaginary[i] = field * sineOf(turns);
        int32_t beam = 0;
        for (int k = 0; k < 3; ++k)
            beam += p.next[k][0] * x + p.next[k][1] * y + p.next_at[k] - p.next_cone[k] * range >= 0;
        fields.cell[i] = inside != 0 ? cell : 0;
        fields.beam[i] = inside != 0 ? beam : 0;
        fields.bits[i] = place;
    }
}

/** From, to. */
struct Span {
    double low, high;
};

/** The whole number below, of what is far from the ends of int32_t. */
int32_t below(double x) {
    const auto whole = static_cast<int32_t>(x);
    return whole - (x < static_cast<double>(whole) ? 1 : 0);
}

/** The outline of a patch on its lattice, from the square that holds its middle [spacings]. */
struct PatchOutline {
    std::array<glm::dvec2, 4> corners;
    glm::dvec2 margin;  ///< It may be so much larger, for its sides are bent.

    Span extent(int axis) const {
        const double a = corners[0][axis], b = corners[1][axis], c = corners[2][axis], d = corners[3][axis];
        return {std::min(std::min(a, b), std::min(c, d)) - margin[axis],
                std::max(std::max(a, b), std::max(c, d)) + margin[axis]};
    }
};

/** An outline row by row of squares. */
class OutlineRows {
public:
    /** Rows are counted along the axis in which the outline is shorter. */
    explicit OutlineRows(const PatchOutline& outline) {
        const Span u = outline.extent(0), v = outline.extent(1);
        axis = v.high - v.low <= u.high - u.low ? 1 : 0;
        const Span rows = axis == 1 ? v : u;
        first = below(rows.low);
        last = below(rows.high);
        const Span other = axis == 1 ? u : v;
        first_across = below(other.low);
        last_across = below(other.high);
        if (isSmall()) return;
        margin_ = outline.margin;
        for (size_t k = 0; k < 4; ++k) {
            const glm::dvec2 a = outline.corners[k], b = outline.corners[(k + 1) % 4];
            const double rise = b[axis] - a[axis];
            sides_[k] = {std::min(a[axis], b[axis]), std::max(a[axis], b[axis]), 0,
                         rise != 0 ? (b[1 - axis] - a[1 - axis]) / rise : 0};
            sides_[k].at_zero = a[1 - axis] - sides_[k].slope * a[axis];
        }
    }
    /** What of it lies in a row, along the other axis. */
    Span span(int row) const {
        const double from = row - margin_[axis], to = row + 1 + margin_[axis];
        Span span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        for (const Side& side : sides_) {
            const double low = std::max(side.low, from), high = std::min(side.high, to);
            if (low > high) continue;
            const double one = side.at_zero + low * side.slope, other = side.at_zero + high * side.slope;
            span = {std::min({span.low, one, other}), std::max({span.high, one, other})};
        }
        return {span.low - margin_[1 - axis], span.high + margin_[1 - axis]};
    }

    /** Few squares, all of which are as good as those of each row. */
    bool isSmall() const { return (last - first + 1) * (last_across - first_across + 1) <= small; }

    static constexpr int small = 32;
    int axis;
    int32_t first, last;
    int32_t first_across, last_across;

private:
    struct Side {
        double low, high, at_zero, slope;
    };
    Side sides_[4];
    glm::dvec2 margin_;
};

double inverseRange(const Patch& patch, const glm::dvec3& direction) {
    return glm::dot(patch.normal, direction) / patch.distance;
}

/** How a point lies past a bearing: past.d + from - cone * range [1, m, 1]. */
void setBearing(bool conical, AngularView::Direction bearing, const glm::dvec3& at, float* past, float& from,
                float& cone) {
    past[0] = static_cast<float>(conical ? 0 : -bearing.sine);
    past[1] = static_cast<float>(conical ? 1 : bearing.cosine);
    from = static_cast<float>(conical ? at.y : bearing.cosine * at.y - bearing.sine * at.x);
    cone = static_cast<float>(conical ? bearing.sine : 0);
}

PatchOutline outlineOf(const Patch& patch, const PatchLattice& lattice, const glm::dvec2& base, double spacing,
                       double near, double far) {
    const glm::dvec3 middle = patch.middle * lattice.range;
    const double per_spacing = 1 / spacing;
    const glm::dvec2 at = lattice.middle * per_spacing - base;
    PatchOutline outline{{}, glm::dvec2(far * patch.width * patch.width * per_spacing / 8)};
    bool is_cut = false;
    for (size_t i = 0; i < 4; ++i) {
        const double whole = 1 / std::max(inverseRange(patch, patch.corners[i]), 1e-9);
        const double range = std::clamp(whole, near, far);
        is_cut = is_cut || range != whole;
        outline.corners[i] = at + lattice.across(range * patch.corners[i] - middle) * per_spacing;
    }
    if (!is_cut) return outline;
    // A corner that is cut off is off the plane, by less than the patch is high.
    const glm::dvec3 up = glm::normalize(glm::dvec3(0, 0, 1) - patch.middle.z * patch.middle);
    outline.margin += glm::abs(lattice.across(up)) * (far * patch.height * per_spacing);
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

LatticePatch partOf(const EchoRules& rules, const Patch& patch, const PatchLattice& lattice, const glm::dvec2& base,
                    const LatticeLevel& level) {
    const glm::dvec3 at = lattice.range * patch.middle;
    LatticePatch part{};
    part.key = mixed(patch.number * 6 + lattice.side + mixed(level.number + 1));
    part.base_u = squareOf(base.x);
    part.base_v = squareOf(base.y);
    part.middle_u = static_cast<float>(lattice.middle.x / level.spacing - base.x);
    part.middle_v = static_cast<float>(lattice.middle.y / level.spacing - base.y);
    for (int i = 0; i < 3; ++i) {
        part.along_u[i] = static_cast<float>(level.spacing * lattice.along[0][i]);
        part.along_v[i] = static_cast<float>(level.spacing * lattice.along[1][i]);
        part.at[i] = static_cast<float>(at[i]);
    }
    setRange(rules, lattice.range, part);
    setBearing(patch.conical, patch.low_bearing, at, part.low, part.low_at, part.low_cone);
    setBearing(patch.conical, patch.high_bearing, at, part.high, part.high_at, part.high_cone);
    std::ranges::fill(part.next_at, -1.0f);
    for (size_t k = 0; k + 1 < patch.beams; ++k)
        setBearing(patch.conical, patch.next_bearings[k], at, part.next[k], part.next_at[k], part.next_cone[k]);
    part.low_sine = static_cast<float>(patch.low_sine);
    part.high_sine = static_cast<float>(patch.high_sine);
    part.amplitude = static_cast<float>(level.spacing *
                                        std::sqrt(patch.strength_range * patch.per_solid_angle * lattice.area_height));
    return part;
}

uint64_t signedQuanta(float field) {
    constexpr double most = 1048576;
    return static_cast<uint64_t>(
        static_cast<int64_t>(std::clamp(static_cast<double>(field), -most, most) * quanta_per_unit));
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

/** Those that a patch may reach: 1/r on a plane is a linear function of the direction. */
Scatterers::Ranges Scatterers::rangesOf(const Patch& patch) const {
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

void Scatterers::deposit(const Patch& patch, size_t beam) {
    if (!(patch.strength_range > 0)) return;
    const Ranges all = rangesOf(patch);
    if (!(all.near < all.far)) return;
    if (frame_of_ != patch.number) {
        frame_ = LatticeFrame(patch.object);
        frame_of_ = patch.number;
    }
    const PatchLattice lattice(patch, frame_);
    double begin = 0;
    for (const LatticeLevel& level : rules_.lattice) {
        const Ranges here{std::max(all.near, begin), std::min(all.far, level.range_end)};
        begin = level.range_end;
        if (here.near < here.far) depositLevel(patch, lattice, level, here, sums_ + beam * beam_sums_);
    }
}

void Scatterers::depositLevel(const Patch& patch, const PatchLattice& lattice, const LatticeLevel& level,
                              const Ranges& ranges, uint64_t* of_beam) {
    const glm::dvec2 base = glm::floor(lattice.middle / level.spacing);
    LatticePatch part = partOf(rules_, patch, lattice, base, level);
    part.near_end = static_cast<float>(ranges.near - lattice.range);
    part.far_end = static_cast<float>(ranges.far - lattice.range);
    const OutlineRows rows(outlineOf(patch, lattice, base, level.spacing, ranges.near, ranges.far));
    int32_t* const across = rows.axis == 1 ? squares_.u : squares_.v;
    int32_t* const up = rows.axis == 1 ? squares_.v : squares_.u;
    int count = 0;
    const auto add = [&] {
        for (int i = count; i < LatticeSquares::most && i % 16 != 0; ++i) squares_.u[i] = squares_.v[i] = 0;
        scatter(part, squares_, count, fields_);
        sum(level, count, of_beam);
        count = 0;
    };
    for (int32_t row = rows.first; rows.isSmall() && row <= rows.last; ++row)
        for (int32_t at = rows.first_across; at <= rows.last_across; ++at, ++count) across[count] = at, up[count] = row;
    for (int32_t row = rows.first; !rows.isSmall() && row <= rows.last; ++row) {
        const Span span = rows.span(row);
        if (!(span.low <= span.high)) continue;
        const int32_t last = below(span.high);
        for (int32_t at = below(span.low); at <= last;) {
            const int32_t end = std::min(last + 1, at + LatticeSquares::most - count);
            for (; at < end; ++at, ++count) across[count] = at, up[count] = row;
            if (count == LatticeSquares::most) add();
        }
    }
    add();
}

void Scatterers::sum(const LatticeLevel& level, int count, uint64_t* of_beam) {
    for (int i = 0; i < count; ++i) {
        float root = 1;
        if (level.stands_for > 0)
            root = std::sqrt(gammaStrength(static_cast<float>(level.stands_for), mixed(fields_.bits[i] + 0x5bd1e995u)));
        uint64_t* const cell = of_beam + static_cast<size_t>(fields_.beam[i]) * beam_sums_ + 2 * fields_.cell[i];
        cell[0] += signedQuanta(root * fields_.real[i]);
        cell[1] += signedQuanta(root * fields_.imaginary[i]);
    }
}

}  // namespace insonify::sonar
