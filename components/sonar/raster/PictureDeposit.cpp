#include "components/sonar/raster/PictureDeposit.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "components/gpu/EglContext.hpp"
#include "components/gpu/Objects.hpp"
#include "components/gpu/Program.hpp"
#include "types/Check.hpp"
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
            if (deposit_.to().truth) cells_.object[i] = Cells::getObject(part_.picture.objects[texel[0] - 1], texel[1]);
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

namespace {

/** Returns a number as the sum of two floats: its float, and the rest. */
vec2 readPair(double number) {
    constexpr double maximum = std::numeric_limits<float>::max();
    const double held = std::clamp(number, -maximum, maximum);
    const auto high = static_cast<float>(held);
    return {high, static_cast<float>(held - static_cast<double>(high))};
}

/** Returns the inverse ranges of the bins' edges: for edge 0 that of the near blanking [1/m]. */
std::vector<float> deviceEdges(const EchoRules& rules) {
    std::vector<float> numbers;
    for (int k = 0; k <= rules.bins.bin_count; ++k) {
        const vec2 edge = readPair(k == 0 ? rules.edges.front() : 1 / rules.bins.edge(k));
        numbers.insert(numbers.end(), {edge.x, edge.y});
    }
    return numbers;
}

std::vector<DeviceShare> deviceShares(const std::vector<ShareRecord>& shares) {
    std::vector<DeviceShare> all;
    for (const ShareRecord& share : shares)
        all.push_back({readPair(share.middle), readPair(share.limit), static_cast<float>(share.width),
                       static_cast<float>(share.shear), share.beam, 0});
    return all;
}

void setPair(GLint place, double number) {
    const vec2 pair = readPair(number);
    glUniform2f(place, pair.x, pair.y);
}

void setFloat(GLint place, double number) { glUniform1f(place, static_cast<float>(number)); }

/** The deposit as a compute shader: pictures stay on the device, only the sums are read back. */
class GpuDeposit final : public BinDeposit {
public:
    GpuDeposit(const DepositSetup& setup, gpu::EglContext& context);
    void begin(const WaterView& water) override {
        water_ = water;
        device_sums_.clear();
    }
    void take(size_t frustum, const SurfacePass& surface) override;
    std::span<const uint64_t> finish() override;

private:
    struct FrustumShares {
        gpu::Buffer starts, shares;
    };
    void setUniforms(const ViewFrustum& frustum, const SurfacePass& surface) const;
    struct Uniforms {
        GLint image_size, bin_count, beam_stride, bin_width, attenuation, strength_scale, axis_cosine, axis_sine,
            extent_u, extent_v, pixel_u, pixel_v, elevation_reach, upward, sonar_height, layer_count, first_elevation,
            first_backscatter, first_facet, first_layer;
    };

    DepositSetup setup_;
    const gpu::EglContext& context_;
    const gpu::Program& program_;
    Uniforms uniforms_;
    GLuint first_elevation_ = 0, first_backscatter_ = 0, first_layer_ = 0;  ///< Indices in `numbers_` [1].
    WaterView water_;                                                       ///< View of the current ping.
    gpu::Buffer numbers_, device_sums_;
    std::vector<FrustumShares> shares_;
    gpu::ReadBack sums_;
};

GpuDeposit::GpuDeposit(const DepositSetup& setup, gpu::EglContext& context)
    : setup_(setup), context_(context), program_(context.programs().compute("deposit.comp.glsl", setup.defines)) {
    const auto at = [this](const char* name) { return glGetUniformLocation(program_.id(), name); };
    uniforms_ = {
        at("image_size"),     at("bin_count"),       at("beam_stride"),       at("bin_width"),   at("attenuation"),
        at("strength_scale"), at("axis_cosine"),     at("axis_sine"),         at("extent_u"),    at("extent_v"),
        at("pixel_u"),        at("pixel_v"),         at("elevation_reach"),   at("upward"),      at("sonar_height"),
        at("layer_count"),    at("first_elevation"), at("first_backscatter"), at("first_facet"), at("first_layer")};
    std::vector<float> numbers = deviceEdges(setup.rules);
    const auto append = [&](const std::vector<double>& table) {
        const auto first = static_cast<GLuint>(numbers.size());
        for (const double number : table) numbers.push_back(static_cast<float>(number));
        return first;
    };
    first_elevation_ = append(setup.rules.elevation_powers);
    first_backscatter_ = append(setup.rules.laws.tables);
    first_layer_ = append(setup.rules.layers);
    numbers_ = gpu::Buffer::of(std::span<const float>(numbers));
    device_sums_ = gpu::Buffer(setup.sumCount() * sizeof(uint64_t));
    for (const ColumnShares& frustum : setup.shares)
        shares_.push_back({gpu::Buffer::of(std::span(frustum.starts)),
                           gpu::Buffer::of(std::span<const DeviceShare>(deviceShares(frustum.shares)))});
    sums_ = gpu::ReadBack(setup.sumCount() * sizeof(uint64_t));
}

void GpuDeposit::setUniforms(const ViewFrustum& frustum, const SurfacePass& surface) const {
    glUniform2i(uniforms_.image_size, frustum.columns, frustum.rows);
    glUniform1ui(uniforms_.bin_count, static_cast<GLuint>(setup_.rules.bins.bin_count));
    glUniform1ui(uniforms_.beam_stride, static_cast<GLuint>(setup_.rules.beamStride()));
    setFloat(uniforms_.bin_width, setup_.rules.bins.bin_width);
    setFloat(uniforms_.attenuation, setup_.rules.attenuation);
    setFloat(uniforms_.strength_scale, setup_.rules.strength_scale);
    setFloat(uniforms_.elevation_reach, setup_.rules.elevation_reach);
    setPair(uniforms_.axis_cosine, std::cos(frustum.azimuth));
    setPair(uniforms_.axis_sine, std::sin(frustum.azimuth));
    setPair(uniforms_.extent_u, frustum.extent_u);
    setPair(uniforms_.extent_v, frustum.extent_v);
    setPair(uniforms_.pixel_u, frustum.du());
    setPair(uniforms_.pixel_v, frustum.dv());
    glUniform1ui(uniforms_.first_elevation, first_elevation_);  // without the feature its place is -1, which GL ignores
    glUniform1ui(uniforms_.first_backscatter, first_backscatter_);
    const size_t vectors = surface.scene().planes().size() * sizeof(PlaneRecord) / sizeof(vec4);
    glUniform1ui(uniforms_.first_facet, static_cast<GLuint>(vectors));
    if (uniforms_.layer_count < 0) return;
    const glm::vec3 up(upwardIn(frustum, water_));
    glUniform3f(uniforms_.upward, up.x, up.y, up.z);
    setFloat(uniforms_.sonar_height, water_.height);
    glUniform1ui(uniforms_.layer_count, static_cast<GLuint>(setup_.rules.layers.size() / 3));
    glUniform1ui(uniforms_.first_layer, first_layer_);
}

void GpuDeposit::take(size_t frustum, const SurfacePass& surface) {
    program_.use();
    setUniforms(setup_.frusta[frustum], surface);
    surface.bindResults(frustum);
    shares_[frustum].shares.bindBase(GL_SHADER_STORAGE_BUFFER, SHARES_BINDING);
    shares_[frustum].starts.bindBase(GL_SHADER_STORAGE_BUFFER, SHARE_STARTS_BINDING);
    numbers_.bindBase(GL_SHADER_STORAGE_BUFFER, NUMBERS_BINDING);
    device_sums_.bindBase(GL_SHADER_STORAGE_BUFFER, SUMS_BINDING);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
    const auto groups = [](int pixels) { return static_cast<GLuint>((pixels + 7) / 8); };
    glDispatchCompute(groups(setup_.frusta[frustum].columns), groups(setup_.frusta[frustum].rows), 1);
}

std::span<const uint64_t> GpuDeposit::finish() {
    const auto alone = context_.transferring();
    sums_.ask(device_sums_);
    return {static_cast<const uint64_t*>(sums_.wait()), setup_.sumCount()};
}

/** Returns the first and end column of the frustum that any beam of [first, last) touches. */
std::array<int, 2> touched(const ColumnShares& shares, uint first, uint last) {
    std::array<int, 2> range{std::numeric_limits<int>::max(), 0};
    for (const ShareRecord& share : shares.shares)
        if (share.beam >= first && share.beam < last) {
            const int column = static_cast<int>(share.column);
            range = {std::min(range[0], column), std::max(range[1], column + 1)};
        }
    return range;
}

}  // namespace

std::unique_ptr<BinDeposit> makeGpuDeposit(const DepositSetup& setup, gpu::EglContext& context) {
    return std::make_unique<GpuDeposit>(setup, context);
}

PictureDeposit::PictureDeposit(DepositSetup setup, const SurfacePass& surface, const gpu::EglContext& context,
                               ThreadPool& threads)
    : setup_(std::move(setup)),
      context_(context),
      threads_(threads),
      planes_(surface.scene().planes()),
      facets_(surface.scene().facets()),
      columns_(static_cast<size_t>(threads.size()), std::vector<std::array<int, 2>>(setup_.shares.size())),
      pictures_(setup_.frusta.size()),
      sums_(setup_.sumCount()) {
    for (size_t i = 0; i < pictures_.size(); ++i) {
        const VisibilityBuffer& rasterised = surface.picture(i);
        pictures_[i].view.channels = static_cast<size_t>(rasterised.channels());
        pictures_[i].words = gpu::ReadBack(rasterised.bytes());
        pictures_[i].view.ranges.reserve(surface.lists().drawLimit());
    }
    touchColumns();
}

void PictureDeposit::begin(const WaterView& water) {
    for (Taken& picture : pictures_) picture.taken = false;
    water_ = water;
}

void PictureDeposit::take(size_t frustum, const SurfacePass& surface) {
    Taken& picture = pictures_[frustum];
    surface.picture(frustum).read(picture.words);
    picture.taken = true;
    picture.view.ranges.clear();
    picture.view.objects.clear();
    for (const CommandRecord& command : surface.lists().commands(frustum)) {
        if (truth_) picture.view.objects.push_back(command.object);
        const FacetRecord* facets = facets_.empty() ? nullptr : facets_.data() + command.first_triangle;
        picture.view.ranges.push_back(placedRun(surface.objects()[command.object], command, setup_.rules,
                                                planes_.data() + command.first_triangle, facets, nullptr));
    }
}

std::span<const uint64_t> PictureDeposit::finish() {
    {
        const auto alone = context_.transferring();
        for (Taken& picture : pictures_)
            if (picture.taken) picture.view.pixels = static_cast<const uint32_t*>(picture.words.wait());
    }
    INSONIFY_CHECK(firstBeam(columns_.size()) == setup_.beam_count, firstBeam(columns_.size()), setup_.beam_count);
    threads_.run([&](int part, int) { depositPart(static_cast<size_t>(part)); });
    return sums_;
}

void PictureDeposit::prepareTruth(std::vector<int32_t> beams) {
    truth_beams_ = std::move(beams);
    one_beam_.assign(columns_.size(), std::vector<uint64_t>(setup_.rules.sumCount()));
    for (Taken& picture : pictures_) picture.view.objects.reserve(picture.view.ranges.capacity());
    touchColumns();
}

void PictureDeposit::touchColumns() {
    for (size_t part = 0; part < columns_.size(); ++part)
        for (size_t i = 0; i < setup_.shares.size(); ++i)
            columns_[part][i] = touched(setup_.shares[i], firstBeam(part), firstBeam(part + 1));
}

void PictureDeposit::depositPart(size_t part) {
    const uint first = firstBeam(part), last = firstBeam(part + 1);
    const size_t stride = setup_.rules.sumCount();
    std::fill(sums_.begin() + static_cast<ptrdiff_t>(first * stride),
              sums_.begin() + static_cast<ptrdiff_t>(last * stride), 0);
    for (size_t i = 0; i < setup_.frusta.size(); ++i) {
        const Taken& taken = pictures_[i];
        if (!taken.taken) continue;
        const PicturePart frustum{setup_.rules, setup_.frusta[i], setup_.shares[i], taken.view, water_, first,
                                  last,         columns_[part][i]};
        if (!truth_) {
            depositPicture(frustum, {0, sums_.data()});
            continue;
        }
        const TruthSink truth{*truth_, truth_beams_, one_beam_[part]};
        depositPicture(frustum, {0, sums_.data(), &truth});
    }
}

uint32_t PictureDeposit::firstBeam(size_t part) const {
    auto first = static_cast<uint32_t>(setup_.beam_count * part / static_cast<size_t>(threads_.size()));
    // The beams of one beam of the truth stay with one thread.
    while (!truth_beams_.empty() && first > 0 && first < setup_.beam_count &&
           truth_beams_[first] == truth_beams_[first - 1])
        ++first;
    return first;
}

}  // namespace insonify::sonar
