#include "components/sonar/CpuDeposit.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::sonar {
namespace {

using std::abs, std::clamp, std::exp, std::max, std::min, std::sqrt, std::tanh;
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

template <class Model> void depositImage(const DepositSetup& setup, size_t index, const float* picture, Model bins, uint first, uint last) {
    const Slab& slab = setup.slabs[index];
    const ColumnShares& shares = setup.shares[index];
    const Columns columns = touched(shares, slab.columns, first, last);
    const double dv = slab.dv(), scale = 1 / (slab.du() * dv);
    for (int row = 0; row < slab.rows; ++row)
        for (int column = columns.begin; column < columns.end; ++column) {
            const float* texel = picture + 4 * (static_cast<size_t>(row) * static_cast<size_t>(slab.columns) + static_cast<size_t>(column));
            if (!(texel[0] > 0) || std::isinf(texel[0])) continue;
            const size_t at = shares.cell(row, column, slab.columns);
            for (uint i = shares.starts[at]; i < shares.starts[at + 1]; ++i) {
                const ShareRecord& share = shares.shares[i];
                if (share.beam < first || share.beam >= last) continue;
                const Footprint cell = cellFootprint(slab.u(column + 0.5), slab.v(row + 0.5), share.u_low, share.u_high, dv,
                                                     setup.tan_elevation, texel[0], texel[1], texel[2]);
                if (cell.solid_angle > 0)
                    bins.depositCell(cell, share.beam, texel[0], texel[3], scale);
            }
        }
}

}  // namespace

CpuDeposit::CpuDeposit(DepositSetup setup, ThreadPool& threads)
    : setup_(std::move(setup)), threads_(threads), edges_(inverseEdges(setup_.bins)), taken_(setup_.slabs.size(), false), sums_(setup_.sumCount()) {
    for (const Slab& slab : setup_.slabs)
        pictures_.emplace_back(4 * static_cast<size_t>(slab.columns) * static_cast<size_t>(slab.rows));
}

void CpuDeposit::take(size_t slab, const gpu::Texture& picture) {
    auto& pixels = pictures_[slab];
    glGetTextureImage(picture.id(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(pixels.size() * sizeof(float)), pixels.data());
    taken_[slab] = true;
}

std::span<const uint64_t> CpuDeposit::finish() {
    threads_.run([this](int part, int parts) {
        const auto edge = [&](int i) { return static_cast<uint32_t>(static_cast<uint64_t>(setup_.beam_count) * static_cast<uint64_t>(i) / static_cast<uint64_t>(parts)); };
        depositBeams(edge(part), edge(part + 1));
    });
    std::fill(taken_.begin(), taken_.end(), false);
    return sums_;
}

void CpuDeposit::depositBeams(uint32_t first, uint32_t last) {
    const size_t stride = static_cast<size_t>(setup_.bins.bin_count) * setup_.channels();
    std::fill(sums_.begin() + static_cast<ptrdiff_t>(first * stride), sums_.begin() + static_cast<ptrdiff_t>(last * stride), 0);
    for (size_t slab = 0; slab < setup_.slabs.size(); ++slab)
        if (taken_[slab]) depositSlab(slab, first, last);
}

void CpuDeposit::depositSlab(size_t slab, uint32_t first, uint32_t last) {
    const Bins bins{edges_.data(), sums_.data(), static_cast<uint>(setup_.bins.bin_count), setup_.bins.bin_width, setup_.attenuation};
    if (setup_.model == Model::Cerqueira2017)
        depositImage(setup_, slab, pictures_[slab].data(), CerqueiraBins{bins}, first, last);
    else
        depositImage(setup_, slab, pictures_[slab].data(), PhysicalBins{bins}, first, last);
}

}  // namespace insonify::sonar
