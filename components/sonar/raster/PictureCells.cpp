#include "components/sonar/raster/PictureCells.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
namespace {

using std::abs, std::sqrt;
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
#include "shaders/jitter.glsl"
#include "shaders/picture.glsl"

/** The table that shaders/elevation.glsl reads. */
struct ElevationTable {
    const double* powers;
    double elevation_reach;
    static uint min(uint a, uint b) { return a < b ? a : b; }
    static double min(double a, double b) { return a < b ? a : b; }
    double elevationPower(uint i) const { return powers[i]; }
#include "shaders/elevation.glsl"
};

/** The shares of a batch of cells. */
struct Shares {
    double u[Cells::capacity], v[Cells::capacity];  ///< Place of the pixel's ray [1].
    double middle[Cells::capacity], width[Cells::capacity], limit[Cells::capacity], shear[Cells::capacity];
};

/** Common values of all cells of a picture. */
struct Frame {
    double cosine, sine;  ///< Cosine and sine of the azimuth of the frustum's axis.
    double dv, per_pixel;
    bool by_rays;  ///< Cells are seen along the rays of their pixels, not in their own middles.
};

/** Sets direction, extent and solid angle of all cells. `by_rays`: as in Frame; a template parameter, because compilers
 *  do not vectorise a loop with this choice. */
template <bool by_rays>
inline __attribute__((always_inline)) void placeEach(const Shares& shares, const Frame& frame,
                                                     Cells& __restrict cells) {
    const int count = cells.count;
    for (int i = 0; i < count; ++i) {
        const double ray_u = shares.u[i], ray_v = shares.v[i];
        const double middle = shares.middle[i], limit = shares.limit[i];
        const double at = ray_v + ray_v * shares.shear[i] * (middle - ray_u);
        const PictureRow row = pictureRow(at, frame.dv, -limit, limit);
        const PictureCell cell = pictureCell(middle, row.middle, shares.width[i], row.rise, frame.per_pixel);
        const double u = by_rays ? ray_u : middle, v = by_rays ? ray_v : row.middle;
        const double level = sqrt(1.0 + u * u), per_level = 1.0 / level, per_length = 1.0 / sqrt(1.0 + u * u + v * v);
        cells.cos_az[i] = (frame.cosine - frame.sine * u) * per_level;
        cells.sin_az[i] = (frame.sine + frame.cosine * u) * per_level;
        cells.cos_el[i] = level * per_length;
        cells.sin_el[i] = v * per_length;
        cells.width[i] = cell.width;
        cells.height[i] = cell.height;
        cells.lean[i] = 0;
        cells.size[i] = cell.size;
    }
}

INSONIFY_VECTOR_CLONES __attribute__((flatten)) void placeAll(const Shares& shares, const Frame& frame,
                                                              Cells& __restrict cells) {
    if (frame.by_rays)
        placeEach<true>(shares, frame, cells);
    else
        placeEach<false>(shares, frame, cells);
}

/** Makes cells of pixels, a batch at a time. */
class PictureCells {
public:
    PictureCells(const PicturePart& part, const EchoSums& to)
        : part_(part),
          deposit_(part.rules, part.water, false, to),
          cells_(deposit_.cells),
          frame_{std::cos(part.frustum.azimuth), std::sin(part.frustum.azimuth), part.frustum.dv(),
                 1 / (part.frustum.du() * part.frustum.dv()), has(Feature::Nearest) || has(Feature::Published)},
          counts_misses_(has(Feature::Published) || part.rules.echoes_from_misses),
          jitters_(has(Feature::Jitter)) {}

    void run() {
        for (int row = 0; row < part_.frustum.rows; ++row)
            for (int column = part_.columns[0]; column < part_.columns[1]; ++column) addPixel(row, column);
        flush();
    }

private:
    bool has(Feature feature) const { return part_.rules.features.has(feature); }

    void addPixel(int row, int column) {
        const size_t columns = static_cast<size_t>(part_.frustum.columns);
        const uint32_t* const texel =
            part_.picture.pixels +
            part_.picture.channels * (static_cast<size_t>(row) * columns + static_cast<size_t>(column));
        if (texel[0] == 0 && !counts_misses_) return;
        const size_t at = part_.shares.cell(row, column, part_.frustum.columns);
        for (uint32_t i = part_.shares.starts[at]; i < part_.shares.starts[at + 1]; ++i)
            if (const ShareRecord& share = part_.shares.shares[i]; share.beam >= part_.first && share.beam < part_.last)
                addCell(texel, share, row, column);
    }

    void addCell(const uint32_t* texel, const ShareRecord& share, int row, int column) {
        const int i = cells_.count;
        if (texel[0] == 0) {
            cells_.setMiss(i);
        } else {
            const PlacedRun& run = part_.picture.ranges[texel[0] - 1];
            cells_.setPlane(i, run, texel[1]);
            if (part_.picture.channels == 4) cells_.mapped[i] = static_cast<double>(std::bit_cast<float>(texel[2]));
            if (deposit_.to().truth) cells_.object[i] = Cells::objectOf(part_.picture.objects[texel[0] - 1], texel[1]);
            cells_.hits[i] = 1;
        }
        cells_.beam[i] = static_cast<int>(share.beam);
        shares_.u[i] = part_.frustum.u(column + 0.5);
        shares_.v[i] = part_.frustum.v(row + 0.5);
        if (jitters_) {
            shares_.u[i] += part_.frustum.du() * jitter(static_cast<uint>(column), static_cast<uint>(row), 0);
            shares_.v[i] += part_.frustum.dv() * jitter(static_cast<uint>(column), static_cast<uint>(row), 1);
        }
        shares_.middle[i] = share.middle;
        shares_.width[i] = share.width;
        shares_.limit[i] = share.limit;
        shares_.shear[i] = share.shear;
        if (++cells_.count == Cells::capacity) flush();
    }

    /** Corrects mapped cosines, which are those of the pixels' rays; on a plane a cosine is in proportion to the
     *  inverse range. */
    void moveMappedCosines() {
        for (int i = 0; i < cells_.count; ++i) {
            if (!(cells_.mapped[i] > 0)) continue;
            const double u = shares_.u[i], v = shares_.v[i], per_length = 1 / sqrt(1 + u * u + v * v);
            const double x = frame_.cosine - frame_.sine * u, y = frame_.sine + frame_.cosine * u;
            const double of_ray =
                (cells_.normal_x[i] * x + cells_.normal_y[i] * y + cells_.normal_z[i] * v) * per_length;
            const double of_cell =
                (cells_.normal_x[i] * cells_.cos_az[i] + cells_.normal_y[i] * cells_.sin_az[i]) * cells_.cos_el[i] +
                cells_.normal_z[i] * cells_.sin_el[i];
            if (of_ray * of_cell > 0) cells_.mapped[i] *= of_cell / of_ray;
        }
    }

    void flush() {
        placeAll(shares_, frame_, cells_);
        if (part_.picture.channels == 4 && !frame_.by_rays) moveMappedCosines();
        if (has(Feature::ElevationPattern)) {
            ElevationTable table{part_.rules.elevation_powers.data(), part_.rules.elevation_reach};
            for (int i = 0; i < cells_.count; ++i) cells_.size[i] *= table.elevationWeight(shares_.u[i], shares_.v[i]);
        }
        deposit_.flush();
    }

    const PicturePart& part_;
    CellDeposit deposit_;
    Cells& cells_;
    Frame frame_;
    bool counts_misses_, jitters_;
    Shares shares_;
};

}  // namespace

void depositPicture(const PicturePart& part, const EchoSums& to) { PictureCells(part, to).run(); }

}  // namespace insonify::sonar
