#include "components/sonar/DepositRow.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "components/sonar/Estimators.hpp"
#include "components/sonar/TruthDeposit.hpp"

namespace insonify::sonar {
namespace {

#include "shaders/jitter.glsl"
#include "shaders/surface.glsl"

/** The table that shaders/elevation.glsl reads. */
struct ElevationTable {
    const double* powers;
    double elevation_reach;
    double elevationPower(uint i) const { return powers[i]; }
#include "shaders/elevation.glsl"
};

constexpr int stretch = 64;  ///< Pixels at a time: their numbers stay in the nearest cache.

/** A stretch of a picture's row. */
struct Pixels {
    double normal_x[stretch], normal_y[stretch], normal_z[stretch], distance[stretch];  ///< Planes, frustum axes.
    double u[stretch], ray_u[stretch], ray_v[stretch], mapped[stretch], strength[stretch];
    double near_limit[stretch], far_limit[stretch], nearest[stretch], facet_slope[stretch];
    uint material[stretch];
    double cosine[stretch], inverse_range[stretch], slope_u[stretch], slope_v[stretch], strength_range[stretch];
};

/** A stretch of shares, each with what its pixel shows. */
struct Shared {
    double middle[stretch], width[stretch], limit[stretch], shear[stretch];
    double u[stretch], inverse_range[stretch], slope_u[stretch], slope_v[stretch], nearest[stretch],
        near_limit[stretch], far_limit[stretch];
    double strength_range[stretch];

    void set(int i, const ShareRecord& share, const Pixels& pixels, uint p) {
        middle[i] = share.middle;
        width[i] = share.width;
        limit[i] = share.limit;
        shear[i] = share.shear;
        u[i] = pixels.u[p];
        inverse_range[i] = pixels.inverse_range[p];
        slope_u[i] = pixels.slope_u[p];
        slope_v[i] = pixels.slope_v[p];
        nearest[i] = pixels.nearest[p];
        near_limit[i] = pixels.near_limit[p];
        far_limit[i] = pixels.far_limit[p];
        strength_range[i] = pixels.strength_range[p];
    }
};

/** What a stretch of shares covers: Footprint as arrays. */
struct Cells {
    double pixel[stretch], centre[stretch], wide[stretch], narrow[stretch], per_wide[stretch], steepness[stretch],
        near_end[stretch], far_end[stretch], nearest[stretch], size[stretch];

    void set(int i, const Footprint& f) {
        pixel[i] = f.pixel;
        centre[i] = f.centre;
        wide[i] = f.wide;
        narrow[i] = f.narrow;
        per_wide[i] = f.per_wide;
        steepness[i] = f.steepness;
        near_end[i] = f.near_end;
        far_end[i] = f.far_end;
        nearest[i] = f.nearest;
        size[i] = f.size;
    }
    Footprint get(int i) const {
        return {pixel[i],     centre[i],   wide[i],    narrow[i],  per_wide[i],
                steepness[i], near_end[i], far_end[i], nearest[i], size[i]};
    }
};

void miss(Pixels& pixels, int i) {
    pixels.normal_x[i] = 1;
    pixels.normal_y[i] = pixels.normal_z[i] = pixels.distance[i] = pixels.strength[i] = pixels.mapped[i] = 0;
    pixels.near_limit[i] = pixels.far_limit[i] = pixels.facet_slope[i] = 0;
    pixels.material[i] = 0;
}

void hit(const PlacedRun& run, const PlaneRecord& plane, double mapped, Pixels& pixels, int i) {
    const vec4 &n = plane.normal, &p = plane.point;
    const auto turned = [&](const double* row) { return row[0] * n.x + row[1] * n.y + row[2] * n.z; };
    const double x = turned(run.normal_x), y = turned(run.normal_y), z = turned(run.normal_z);
    pixels.normal_x[i] = x;
    pixels.normal_y[i] = y;
    pixels.normal_z[i] = z;
    pixels.distance[i] = n.x * (p.x - run.eye[0]) + n.y * (p.y - run.eye[1]) + n.z * (p.z - run.eye[2]) + n.w;
    pixels.mapped[i] = mapped;
    pixels.strength[i] = run.strength;
    pixels.near_limit[i] = run.near_limit;
    pixels.far_limit[i] = run.far_limit;
    pixels.facet_slope[i] = p.w;
    pixels.material[i] = run.material;
}

/** Looks up what `count` pixels from `first` show; false when all are misses. */
bool look(const FrustumPart& part, int row, int first, int count, Pixels& pixels) {
    const TakenPicture& picture = part.picture;
    const size_t at = static_cast<size_t>(row) * static_cast<size_t>(part.frustum.columns) + static_cast<size_t>(first);
    const uint32_t* texel = picture.pixels + picture.channels * at;
    bool any = false;
    for (int i = 0; i < count; ++i, texel += picture.channels) {
        if (texel[0] == 0) {
            miss(pixels, i);
            continue;
        }
        any = true;
        const PlacedRun& run = picture.ranges[texel[0] - 1];
        const double mapped = picture.channels == 4 ? static_cast<double>(std::bit_cast<float>(texel[2])) : 0;
        hit(run, part.planes[run.first_triangle + texel[1]], mapped, pixels, i);
    }
    return any;
}

/** Where each pixel is looked at: its centre, or a point at random in it. */
template <bool jittered>
void aim(const FrustumPart& part, int row, int first, int count, Pixels& pixels) {
    for (int i = 0; i < count; ++i) {
        pixels.ray_u[i] = pixels.u[i] = part.frustum.u(first + i + 0.5);
        pixels.ray_v[i] = part.frustum.v(row + 0.5);
        if (!jittered) continue;
        const auto x = static_cast<uint>(first + i), y = static_cast<uint>(row);
        pixels.ray_u[i] += part.frustum.du() * jitter(x, y, 0);
        pixels.ray_v[i] += part.frustum.dv() * jitter(x, y, 1);
    }
}

INSONIFY_VECTOR_CLONES void meet(Pixels& pixels, int count) {
    for (int i = 0; i < count; ++i) {
        const Surface surface = surfaceAt(pixels.normal_x[i], pixels.normal_y[i], pixels.normal_z[i],
                                          pixels.distance[i], pixels.ray_u[i], pixels.ray_v[i]);
        pixels.cosine[i] = pixels.mapped[i] == 0 ? surface.cosine : pixels.mapped[i];
        pixels.inverse_range[i] = surface.inverse_range;
        pixels.slope_u[i] = surface.slope_u;
        pixels.slope_v[i] = surface.slope_v;
        pixels.nearest[i] = surface.nearest;
        pixels.strength_range[i] = pixels.strength[i] * pixels.cosine[i] * surface.range;
    }
}

/** The strength of what does not follow Lambert's law. */
void applyLaws(const FrustumPart& part, double v, int count, Pixels& pixels) {
    const MaterialLaws& laws = part.rules.laws;
    const double widest = std::max(part.frustum.du(), part.frustum.dv());
    for (int i = 0; i < count; ++i) {
        if (laws.followsLambert(pixels.material[i]) || pixels.inverse_range[i] == 0) continue;
        const double angle = widest / sqrt(1 + pixels.u[i] * pixels.u[i] + v * v);
        pixels.strength_range[i] = part.rules.strength_scale / pixels.inverse_range[i] *
                                   laws.overCosine(pixels.material[i], pixels.cosine[i], pixels.facet_slope[i], angle);
    }
}

/** From where and at which angle sound meets each pixel. */
INSONIFY_VECTOR_CLONES void regard(const Pixels& pixels, int count, CellTruths<stretch>& __restrict shown) {
    for (int i = 0; i < count; ++i) {
        const double x = pixels.normal_x[i], y = pixels.normal_y[i], z = pixels.normal_z[i];
        const double u = pixels.ray_u[i], v = pixels.ray_v[i], per_length = 1.0 / sqrt(1.0 + u * u + v * v);
        shown.sine_elevation[i] = v * per_length;
        shown.sine_grazing[i] = abs(x + u * y + v * z) * per_length / sqrt(x * x + y * y + z * z);
    }
}

/** The same of all cells of a stretch. */
struct Reach {
    double v, dv, near_edge, far_edge, per_pixel;
};

INSONIFY_VECTOR_CLONES void cover(const Shared& shared, int count, const Reach& reach, Cells& __restrict cells) {
    for (int i = 0; i < count; ++i)
        cells.set(i, cellFootprint(shared.u[i], reach.v, shared.middle[i], shared.width[i], shared.limit[i],
                                   shared.shear[i], reach.dv, shared.inverse_range[i], shared.slope_u[i],
                                   shared.slope_v[i], shared.nearest[i], shared.near_limit[i], shared.far_limit[i],
                                   reach.near_edge, reach.far_edge, reach.per_pixel));
}

/** The part row by row, a stretch of pixels and then of shares at a time. */
template <class Estimator, bool conical>
class PartDeposit {
public:
    static constexpr Features features() {
        Features all = Estimator::features;
        if (conical) all.add(Feature::Conical);
        return all;
    }

    PartDeposit(const FrustumPart& part, uint64_t* sums, const TruthSink* truth)
        : part_(part),
          sums_(sums),
          bins_(part.rules, sums, truth),
          per_pixel_(1 / (part.frustum.du() * part.frustum.dv())) {}

    void run() {
        for (int row = 0; row < part_.frustum.rows; ++row)
            for (int column = part_.columns[0]; column < part_.columns[1]; column += stretch)
                pixels(row, column, std::min(stretch, part_.columns[1] - column));
    }

private:
    void pixels(int row, int first, int count) {
        if (!look(part_, row, first, count, pixels_) && !countsMisses()) return;
        aim<Estimator::features.has(Feature::Jitter)>(part_, row, first, count, pixels_);
        meet(pixels_, count);
        if constexpr (Estimator::tells_truth) regard(row, first, count);
        if (part_.rules.features.has(Feature::BackscatterLaws))
            applyLaws(part_, part_.frustum.v(row + 0.5), count, pixels_);
        const size_t at = static_cast<size_t>(conical ? row : 0) * static_cast<size_t>(part_.frustum.columns) +
                          static_cast<size_t>(first);
        const uint end = part_.shares.starts[at + static_cast<size_t>(count)];
        for (uint i = part_.shares.starts[at]; i < end; i += stretch)
            shares(i, static_cast<int>(std::min<uint>(stretch, end - i)), static_cast<uint>(first),
                   part_.frustum.v(row + 0.5));
    }

    void shares(uint first_share, int count, uint first_column, double v) {
        const ShareRecord* shares = part_.shares.shares.data() + first_share;
        for (int i = 0; i < count; ++i) shared_.set(i, shares[i], pixels_, shares[i].column - first_column);
        cover(shared_, count,
              {v, part_.frustum.dv(), part_.rules.edges.front(), bins_.binEdge(bins_.bin_count), per_pixel_}, cells_);
        if (part_.rules.features.has(Feature::ElevationPattern)) weigh(count, v);
        if (part_.rules.features.has(Feature::VolumeLayers))
            hideVolume<LayeredVolume>(shares, count, v);
        else if (part_.rules.features.has(Feature::Volume))
            hideVolume<OpenVolume>(shares, count, v);
        for (int i = 0; i < count; ++i) {
            if (shares[i].beam < part_.first || shares[i].beam >= part_.last) continue;
            if constexpr (Estimator::tells_truth)
                bins_.regard(shown_.get(static_cast<int>(shares[i].column - first_column)));
            bins_.depositCell(cells_.get(i), shares[i].beam, shared_.strength_range[i]);
        }
    }

    /** Notes what `count` pixels from `first` show; a pixel that beams share is one sample of each. */
    void regard(int row, int first, int count) {
        const TakenPicture& picture = part_.picture;
        const uint32_t* texel =
            picture.pixels + picture.channels * (static_cast<size_t>(row) * static_cast<size_t>(part_.frustum.columns) +
                                                 static_cast<size_t>(first));
        for (int i = 0; i < count; ++i, texel += picture.channels) {
            shown_.object[i] = texel[0] == 0 ? -1 : static_cast<int64_t>(picture.objects[texel[0] - 1]);
            shown_.hits[i] = 1;
        }
        sonar::regard(pixels_, count, shown_);
    }

    void weigh(int count, double v) {
        ElevationTable table{part_.rules.elevation_powers.data(), part_.rules.elevation_reach};
        for (int i = 0; i < count; ++i) cells_.size[i] *= table.elevationWeight(shared_.u[i], v);
    }

    bool countsMisses() const {
        return Estimator::features.has(Feature::Published) || part_.rules.features.has(Feature::VolumeLayers);
    }

    template <class Volume>
    void hideVolume(const ShareRecord* shares, int count, double v) {
        Volume volume(part_.rules, part_.picture.water.height, sums_);
        const glm::dvec3 up = upwardIn(part_.frustum, part_.picture.water);
        for (int i = 0; i < count; ++i) {
            if (shares[i].beam < part_.first || shares[i].beam >= part_.last) continue;
            const double u = shared_.u[i], rise = (up.x + up.y * u + up.z * v) / sqrt(1 + u * u + v * v);
            const Footprint cell = cells_.get(i);
            if (cell.pixel > 0)
                volume.hideVolume(cell, shares[i].beam, rise, cell.size);
            else if constexpr (Volume::hears_misses)
                volume.hearLayers(shares[i].beam, rise, part_.rules.bins.range_max, cell.size);
        }
    }

    const FrustumPart& part_;
    uint64_t* sums_;
    Estimator bins_;
    double per_pixel_;  ///< 1 / solid angle of a whole pixel at the picture's centre [1/sr].
    Pixels pixels_;
    Shared shared_;
    Cells cells_;
    CellTruths<Estimator::tells_truth ? stretch : 1> shown_{};
};

/** Calls use.operator()<Deposit>() with the PartDeposit that has the features of a plan. */
template <template <class> class Telling, class Use>
void withParts(const Features& features, const Use& use) {
    withEstimator<Features{}>(features, [&]<class Deposited>() {
        using Estimator = Telling<Deposited>;
        if (features.has(Feature::Conical))
            use.template operator()<PartDeposit<Estimator, true>>();
        else
            use.template operator()<PartDeposit<Estimator, false>>();
    });
}

}  // namespace

PlacedRun placedRun(const ObjectRecord& object, const CommandRecord& command, const EchoRules& rules, double cosine,
                    double sine) {
    const vec4& values = rules.laws.records[command.material].values;
    const double strength = double{rules.features.has(Feature::Cerqueira2017) ? values.y : values.x};
    PlacedRun run{{},
                  {},
                  {},
                  {},
                  object.extent.x,
                  object.extent.y,
                  strength * rules.strength_scale,
                  command.first_triangle,
                  command.material};
    for (int i = 0; i < 3; ++i) {
        const double x = object.normal_x[i], y = object.normal_y[i];
        run.normal_x[i] = cosine * x + sine * y;
        run.normal_y[i] = cosine * y - sine * x;
        run.normal_z[i] = object.normal_z[i];
        run.eye[i] = double{object.eye[i]} + double{object.eye_rest[i]};
    }
    return run;
}

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void deposit(const FrustumPart& part, uint64_t* sums) {
    withParts<Untold>(part.rules.features, [&]<class Deposit>() { Deposit(part, sums, nullptr).run(); });
}

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void depositAndTell(const FrustumPart& part, uint64_t* sums,
                                                                    const TruthSink& truth) {
    withParts<Told>(part.rules.features, [&]<class Deposit>() { Deposit(part, sums, &truth).run(); });
}

Features compiledForPictures(const Features& wanted) {
    Features compiled;
    withParts<Untold>(wanted, [&]<class Deposit>() { compiled = Deposit::features(); });
    return compiled;
}

}  // namespace insonify::sonar
