#include "components/sonar/field/Scatterers.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <utility>

#include "components/sonar/field/RandomFields.hpp"
#include "types/VectorMath.hpp"

namespace insonify::sonar {

/** What is the same for all scatterers of a patch on one lattice. They lie u and v spacings from its middle. */
struct LatticePatch {
    /** A linear function of u and v: constant + u * along_u + v * along_v. */
    struct Plane {
        float constant, along_u, along_v;
    };
    uint32_t key, base_u, base_v;  ///< The square of the middle.
    float middle_u, middle_v;      ///< Where it lies in that [spacings].
    float range;                   ///< Slant range of the middle [m].
    float square_u, square_v, square_uu, square_uv,
        square_vv;               ///< Change of the squared slant range from the middle on.
    Plane height, aside, ahead;  ///< In the direction of the middle's bearing [m].
    float ahead_per_range;
    float columns[Patch::max_columns + 1], rows[Patch::max_rows + 1];
    uint32_t seen;
    int32_t sum, next_sums[Patch::max_columns - 1];  ///< The beam's first sum; on to that of the next column.
    float near_end, far_end;                         ///< Slant ranges, from the middle's [m].
    float amplitude;                                 ///< Times the square root of a power over the square of the range.
    float turns, turns_per_metre;                    ///< Phase of the middle, two way.
    float cells_per_metre;
    uint32_t cell_count;
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
    double range;         ///< Slant range of the middle [m].
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
    const int whole_vectors = (count + LatticeSquares::at_once - 1) & ~(LatticeSquares::at_once - 1);
    for (int i = 0; i < whole_vectors; ++i) {
        const uint32_t place = mixed(mixed(p.base_u + static_cast<uint32_t>(squares.u[i]) + p.key) + p.base_v +
                                     static_cast<uint32_t>(squares.v[i]));
        const uint32_t power = mixed(place + 0x632be5abu);
        const float u = static_cast<float>(squares.u[i]) + uniform(place) - p.middle_u;
        const float v = static_cast<float>(squares.v[i]) + uniform(place >> 16) - p.middle_v;
        const float change = u * (p.square_u + p.square_uu * u + p.square_uv * v) + v * (p.square_v + p.square_vv * v);
        const float square = p.range * p.range + change;
        const float range = std::sqrt(square > 1e-12f ? square : 1e-12f), sum = p.range + range;
        const float per_both = 1 / (range * sum);  // one division for two
        const float further = change * per_both * range, per_range = per_both * sum;
        const float height = p.height.constant + u * p.height.along_u + v * p.height.along_v;
        const float aside = p.aside.constant + u * p.aside.along_u + v * p.aside.along_v;
        const float ahead = p.ahead.constant + u * p.ahead.along_u + v * p.ahead.along_v + p.ahead_per_range * range;
        int32_t sample = 0, first_sum = p.sum;
        for (int k = 0; k < 3; ++k) {
            sample += height >= p.rows[k + 1] * range ? Patch::max_columns : 0;
            const bool past = aside >= p.columns[k + 1] * ahead;
            sample += past ? 1 : 0;
            first_sum += past ? p.next_sums[k] : 0;
        }
        const auto cell = static_cast<int32_t>(range * p.cells_per_metre);
        const int inside = (height >= p.rows[0] * range) & (height < p.rows[4] * range) &
                           (aside >= p.columns[0] * ahead) & (aside < p.columns[4] * ahead) & (further >= p.near_end) &
                           (further < p.far_end) & (static_cast<uint32_t>(cell) < p.cell_count) &
                           static_cast<int>(p.seen >> sample);
        const float field = p.amplitude * std::sqrt(-logarithm(uniform(power))) * per_range * per_range * per_range *
                            (static_cast<float>(cell) + 0.5f);
        const float phase = p.turns + p.turns_per_metre * further + uniform(power >> 16);
        const float turns = phase - nearest(phase);
        fields.real[i] = field * cosineOf(turns);
        fields.imaginary[i] = field * sineOf(turns);
        fields.sum[i] = (inside & 1) != 0 ? first_sum + static_cast<int32_t>(2 * static_cast<uint32_t>(cell)) : -1;
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

/** The squares of a lattice that an outline meets, row by row. */
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
    /** The first and the last square of a row, along the other axis. */
    std::pair<int32_t, int32_t> across(int32_t row) const {
        double low = first_across_, high = last_across_;
        for (const Side& side : {lows_[0], lows_[1]}) low = std::max(low, side.at_zero + row * side.slope);
        for (const Side& side : {highs_[0], highs_[1]}) high = std::min(high, side.at_zero + row * side.slope);
        return {-below(-std::min(low, last_across_ + 1.0)), below(std::max(high, first_across_ - 1.0))};
    }

    int32_t first, last;

private:
    /** Where a square of a row touches it. */
    struct Side {
        double at_zero, slope = 0;
    };

    /** Half planes: what lies within those of all sides is the outline, or more where it is not convex. */
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

double inverseRange(const Patch& patch, const glm::dvec3& direction) {
    return glm::dot(patch.normal, direction) / patch.distance;
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

/** Returns the part in a direction of a point at `at`, and of u and v along their axes. */
LatticePatch::Plane planeOf(const glm::dvec3& direction, const glm::dvec3& at, const glm::dvec3& along_u,
                            const glm::dvec3& along_v) {
    const auto part = [&](const glm::dvec3& of) { return static_cast<float>(glm::dot(direction, of)); };
    return {part(at), part(along_u), part(along_v)};
}

/** Sets where scatterers are seen: edges of samples, and the sums of their beams. */
void setSamples(const EchoRules& rules, const Patch& patch, LatticePatch& part) {
    std::ranges::transform(patch.columns, part.columns, [](double edge) { return static_cast<float>(edge); });
    std::ranges::transform(patch.rows, part.rows, [](double edge) { return static_cast<float>(edge); });
    part.seen = patch.seen;
    const auto sums = static_cast<int32_t>(rules.sumCount());
    part.sum = static_cast<int32_t>(patch.beams[0]) * sums;
    for (size_t k = 0; k + 1 < Patch::max_columns; ++k)
        part.next_sums[k] = static_cast<int32_t>(patch.beams[k + 1] - patch.beams[k]) * sums;
}

LatticePatch partOf(const EchoRules& rules, const Patch& patch, const PatchLattice& lattice, const glm::dvec2& base,
                    const LatticeLevel& level) {
    const glm::dvec3 at = lattice.range * patch.middle, along_u = level.spacing * lattice.along[0],
                     along_v = level.spacing * lattice.along[1];
    LatticePatch part{};
    part.key = mixed(patch.number * 6 + lattice.side + mixed(level.number + 1));
    part.base_u = squareOf(base.x);
    part.base_v = squareOf(base.y);
    part.middle_u = static_cast<float>(lattice.middle.x / level.spacing - base.x);
    part.middle_v = static_cast<float>(lattice.middle.y / level.spacing - base.y);
    part.range = static_cast<float>(lattice.range);
    part.square_u = static_cast<float>(2 * glm::dot(at, along_u));
    part.square_v = static_cast<float>(2 * glm::dot(at, along_v));
    part.square_uu = static_cast<float>(glm::dot(along_u, along_u));
    part.square_uv = static_cast<float>(2 * glm::dot(along_u, along_v));
    part.square_vv = static_cast<float>(glm::dot(along_v, along_v));
    const AngularView::Direction towards = patch.conical ? AngularView::Direction{1, 0} : patch.bearing;
    part.height = planeOf({0, 0, 1}, at, along_u, along_v);
    part.aside = planeOf({-towards.sine, towards.cosine, 0}, at, along_u, along_v);
    if (patch.conical)
        part.ahead_per_range = 1;
    else
        part.ahead = planeOf({towards.cosine, towards.sine, 0}, at, along_u, along_v);
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

void Scatterers::deposit(const Patch& patch) {
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
        if (here.near < here.far) depositLevel(patch, lattice, level, here);
    }
}

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void Scatterers::depositLevel(const Patch& patch,
                                                                              const PatchLattice& lattice,
                                                                              const LatticeLevel& level,
                                                                              const Ranges& ranges) {
    const glm::dvec2 base = glm::floor(lattice.middle / level.spacing);
    LatticePatch part = partOf(rules_, patch, lattice, base, level);
    part.near_end = static_cast<float>(ranges.near - lattice.range);
    part.far_end = static_cast<float>(ranges.far - lattice.range);
    const OutlineRows rows(outlineOf(patch, lattice, base, level.spacing, ranges.near, ranges.far));
    int32_t* const across = rows.isAlong(1) ? squares_.u : squares_.v;
    int32_t* const up = rows.isAlong(1) ? squares_.v : squares_.u;
    int count = 0;
    for (int32_t row = rows.first; row <= rows.last; ++row)
        for (auto [at, last] = rows.across(row); at <= last; at += LatticeSquares::at_once) {
            if (count > LatticeSquares::most - LatticeSquares::at_once) {
                add(part, level, count);
                count = 0;
            }
            for (int i = 0; i < LatticeSquares::at_once; ++i) across[count + i] = at + i;
            for (int i = 0; i < LatticeSquares::at_once; ++i) up[count + i] = row;
            count += std::min(last - at + 1, LatticeSquares::at_once);
        }
    add(part, level, count);
}

void Scatterers::add(const LatticePatch& part, const LatticeLevel& level, int count) {
    scatter(part, squares_, count, fields_);
    int inside = 0;
    for (int i = 0; i < count; ++i) {
        inside_[inside] = i;
        inside += fields_.sum[i] >= 0 ? 1 : 0;
    }
    for (int k = 0; k < inside; ++k) {
        const int i = inside_[k];
        float root = 1;
        if (level.stands_for > 0)
            root = std::sqrt(gammaStrength(static_cast<float>(level.stands_for), mixed(fields_.bits[i] + 0x5bd1e995u)));
        uint64_t* const cell = sums_ + fields_.sum[i];
        cell[0] += signedQuanta(root * fields_.real[i]);
        cell[1] += signedQuanta(root * fields_.imaginary[i]);
    }
}

}  // namespace insonify::sonar
