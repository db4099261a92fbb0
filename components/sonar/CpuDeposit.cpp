#include "components/sonar/CpuDeposit.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace insonify::sonar {
namespace {

using std::abs, std::clamp, std::exp, std::max, std::min, std::sqrt, std::tanh;
#include "shaders/surface.glsl"
#include "shaders/footprint.glsl"

/** Where the shared code of shaders/deposit.glsl finds its bins; HAVE_CERQUEIRA2017 chooses the model at compile time. */
struct Bins {
    const double* edges;
    uint64_t* sums;
    uint bin_count;
    double bin_width, attenuation;
    double binEdge(uint k) const { return edges[k]; }
    static uint64_t quanta(double amount) {
        return static_cast<uint64_t>(std::min(amount, 1048576.0) * quanta_per_unit + 0.5);
    }
};

struct PhysicalBins : Bins {
    void addToBin(uint beam, uint bin, double amount, double) const { sums[beam * bin_count + bin] += quanta(amount); }
#include "shaders/deposit.glsl"
};

struct CerqueiraBins : Bins {
    void addToBin(uint beam, uint bin, double amount, double weight) const {
        uint64_t* cell = sums + 2 * static_cast<size_t>(beam * bin_count + bin);
        cell[0] += quanta(amount);
        cell[1] += quanta(weight);
    }
#define HAVE_CERQUEIRA2017
#include "shaders/deposit.glsl"
#undef HAVE_CERQUEIRA2017
};

/** Columns of the slab that any beam of [first, last) touches. */
struct Columns { int begin, end; };
Columns touched(const ColumnShares& shares, int columns, uint first, uint last) {
    Columns range{columns, 0};
    for (size_t at = 0; at + 1 < shares.starts.size(); ++at)
        for (uint i = shares.starts[at]; i < shares.starts[at + 1]; ++i)
            if (shares.shares[i].beam >= first && shares.shares[i].beam < last) {
                const int column = static_cast<int>(at) % columns;
                range = {std::min(range.begin, column), std::max(range.end, column + 1)};
            }
    return range;
}

Surface surfaceOf(const CpuDeposit::Run& run, const vec4& plane, double u, double v) {
    const auto turned = [&](const double* row) { return row[0] * plane.x + row[1] * plane.y + row[2] * plane.z; };
    const double x = turned(run.normal_x), y = turned(run.normal_y), z = turned(run.normal_z);
    return surfaceAt(x, y, z, x * run.origin[0] + y * run.origin[1] + z * run.origin[2] + plane.w, u, v);
}

/** What one thread does with one slab. */
template <class Model> struct SlabJob {
    const DepositSetup& setup;
    const Slab& slab;
    const ColumnShares& shares;
    const CpuDeposit::Picture& picture;
    const std::vector<vec4>& planes;
    size_t channels;
    Model bins;
    uint first, last;  ///< Beams.

    void run() {
        const Columns columns = touched(shares, slab.columns, first, last);
        for (int row = 0; row < slab.rows; ++row)
            for (int column = columns.begin; column < columns.end; ++column) pixel(row, column);
    }

    void pixel(int row, int column) {
        const uint32_t* texel = picture.words.data() + channels * (static_cast<size_t>(row) * static_cast<size_t>(slab.columns) + static_cast<size_t>(column));
        if (texel[0] == 0) return;
        const double u = slab.u(column + 0.5), v = slab.v(row + 0.5);
        const CpuDeposit::Run& seen = picture.runs[texel[0] - 1];
        const Surface surface = surfaceOf(seen, planes[seen.first_triangle + texel[1]], u, v);
        if (surface.range == 0) return;
        const bool mapped = channels == 4 && texel[2] != 0;
        const double strength = seen.strength * (mapped ? static_cast<double>(std::bit_cast<float>(texel[2])) : surface.cosine);
        spread(row, column, u, v, surface, strength, seen);
    }

    void spread(int row, int column, double u, double v, const Surface& surface, double strength, const CpuDeposit::Run& seen) {
        const size_t at = shares.cell(row, column, slab.columns);
        const double dv = slab.dv(), scale = 1 / (slab.du() * dv);
        for (uint i = shares.starts[at]; i < shares.starts[at + 1]; ++i) {
            const ShareRecord& share = shares.shares[i];
            if (share.beam < first || share.beam >= last) continue;
            const Footprint cell = cellFootprint(u, v, share.u_low, share.u_high, dv, setup.tan_elevation, surface.range, surface.slope_u, surface.slope_v);
            if (cell.solid_angle > 0) bins.depositCell(cell, share.beam, surface.range, strength, scale, seen.near_limit, seen.far_limit);
        }
    }
};

CpuDeposit::Run placed(const ObjectRecord& object, double strength, uint32_t first_triangle, double cosine, double sine) {
    CpuDeposit::Run run{{}, {}, {}, {}, object.extent.x, object.extent.y, strength, first_triangle};
    for (int i = 0; i < 3; ++i) {
        const double x = object.normal_x[i], y = object.normal_y[i];
        run.normal_x[i] = cosine * x + sine * y;
        run.normal_y[i] = cosine * y - sine * x;
        run.normal_z[i] = object.normal_z[i];
    }
    run.origin[0] = cosine * object.row_x.w + sine * object.row_y.w;
    run.origin[1] = cosine * object.row_y.w - sine * object.row_x.w;
    run.origin[2] = object.row_z.w;
    return run;
}

}  // namespace

CpuDeposit::CpuDeposit(DepositSetup setup, const SurfacePass& surface, ThreadPool& threads)
    : setup_(std::move(setup)), threads_(threads), edges_(inverseEdges(setup_.bins)), planes_(surface.scene().planes()),
      channels_(static_cast<size_t>(surface.channels())), pictures_(setup_.slabs.size()), sums_(setup_.sumCount()) {
    for (size_t i = 0; i < pictures_.size(); ++i) {
        pictures_[i].words.resize(channels_ * static_cast<size_t>(setup_.slabs[i].columns) * static_cast<size_t>(setup_.slabs[i].rows));
        pictures_[i].runs.reserve(surface.commands().capacity());
    }
}

void CpuDeposit::take(size_t slab, const SurfacePass& surface) {
    Picture& picture = pictures_[slab];
    surface.read(picture.words);
    picture.taken = true;
    picture.runs.clear();
    const double cosine = std::cos(setup_.slabs[slab].azimuth), sine = std::sin(setup_.slabs[slab].azimuth);
    const int value = setup_.model == Model::Cerqueira2017 ? 1 : 0;
    for (const CommandRecord& command : surface.commands())
        picture.runs.push_back(placed(surface.objects()[command.object], surface.scene().materials()[command.material].values[value],
                                      command.first_triangle, cosine, sine));
}

std::span<const uint64_t> CpuDeposit::finish() {
    threads_.run([this](int part, int parts) {
        const auto edge = [&](int i) { return static_cast<uint32_t>(static_cast<uint64_t>(setup_.beam_count) * static_cast<uint64_t>(i) / static_cast<uint64_t>(parts)); };
        depositBeams(edge(part), edge(part + 1));
    });
    for (Picture& picture : pictures_) picture.taken = false;
    return sums_;
}

void CpuDeposit::depositBeams(uint32_t first, uint32_t last) {
    const size_t stride = static_cast<size_t>(setup_.bins.bin_count) * setup_.channels();
    std::fill(sums_.begin() + static_cast<ptrdiff_t>(first * stride), sums_.begin() + static_cast<ptrdiff_t>(last * stride), 0);
    for (size_t slab = 0; slab < setup_.slabs.size(); ++slab)
        if (pictures_[slab].taken) depositSlab(slab, first, last);
}

void CpuDeposit::depositSlab(size_t slab, uint32_t first, uint32_t last) {
    const Bins bins{edges_.data(), sums_.data(), static_cast<uint>(setup_.bins.bin_count), setup_.bins.bin_width, setup_.attenuation};
    const auto run = [&](auto model) {
        SlabJob<decltype(model)>{setup_, setup_.slabs[slab], setup_.shares[slab], pictures_[slab], planes_, channels_, model, first, last}.run();
    };
    if (setup_.model == Model::Cerqueira2017) run(CerqueiraBins{bins});
    else run(PhysicalBins{bins});
}

}  // namespace insonify::sonar
