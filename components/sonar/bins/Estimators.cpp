// The estimators of bins on the processor, each with and without truth. shaders/deposit.glsl is the arithmetic that
// they share with the compute shader; a HAVE_<FEATURE> that is defined while it is included chooses its operations.
#include "components/sonar/bins/Estimators.hpp"

#include <algorithm>
#include <cmath>

#include "components/sonar/bins/CellDeposit.hpp"
#include "components/sonar/bins/Truth.hpp"

namespace insonify::sonar {
namespace {

/** Truth of a cell. */
struct CellTruth {
    int64_t object = -1;  ///< As Cells::object.
    uint32_t hits = 0;    ///< Samples of the cell [1].
    uint32_t beam = 0;    ///< As Cells::beam [1].
    double sine_elevation = 0, sine_grazing = 0;
};

/** An estimator that deposits into a beam of its own first, and from there into the sums and the truth: the same
 *  numbers in both. */
template <class Estimator>
class TruthEstimator : public Estimator {
public:
    TruthEstimator(const EchoRules& rules, uint64_t* all_sums, const TruthSink* truth)
        : Estimator(rules, truth->one_beam.data()),
          truth_(*truth),
          channels_(rules.channels()),
          beam_numbers_(rules.sumCount()),
          all_(all_sums),
          selection_(rules.selection) {}

    /** Sets the truth of the next deposit. */
    void setCell(const CellTruth& cell) { shown_ = cell; }

    void depositCell(const Footprint& cell, uint beam, double strength_range) {
        Estimator::depositCell(cell, 0, strength_range);
        uint64_t* const to = all_ + static_cast<size_t>(beam) * beam_numbers_;
        const int32_t row = shown_.object < 0 ? -1 : truth_.getRow(beam);
        const auto [first, last] = touched(cell);
        if (first > 0 && Estimator::features.has(Feature::Published)) move(0, to, -1);  // echoes out of range
        for (uint bin = first; bin < last; ++bin) move(bin, to, row);
    }

private:
    struct Stretch {
        uint first, last;
    };
    /** Returns the first and end bins in which a deposit of the cell may be. */
    Stretch touched(const Footprint& cell) const {
        constexpr bool one_bin =
            Estimator::features.has(Feature::Nearest) || Estimator::features.has(Feature::Published);
        if (one_bin) return touchedByCentre(cell);
        if (!(cell.near_end > cell.far_end)) return {0, 0};
        uint bin = nearBin(cell.near_end);
        while (bin > 0u && this->edges[bin] < cell.near_end) --bin;
        const uint first = bin;
        while (bin<this->bin_count&& this->edges[bin]> cell.far_end) ++bin;
        return {first, bin};
    }
    /** Returns the bins of a cell that is deposited as a whole at its centre, with a tolerance of one bin. */
    Stretch touchedByCentre(const Footprint& cell) const {
        const uint bin = cell.pixel > 0 ? nearBin(cell.pixel) : 0;
        return {bin > 0 ? bin - 1 : 0, std::min(bin + 2, this->bin_count)};
    }
    uint nearBin(double inverse_range) const {
        return uint(min(1.0 / (inverse_range * this->bin_width), this->bin_count - 1.0));
    }
    void move(uint bin, uint64_t* to, int32_t row) {
        uint64_t* const own = truth_.one_beam.data() + bin * channels_;
        if (selection_ && own[0] > 0 && !isSelected(bin, own[0])) own[0] = 0;
        const uint64_t energy = own[0];
        for (size_t channel = 0; channel < channels_; ++channel) {
            to[bin * channels_ + channel] += own[channel];
            own[channel] = 0;
        }
        if (energy > 0 && row >= 0)
            truth_.table.add(static_cast<size_t>(row), bin,
                             ObjectEcho::of(energy, shown_.sine_elevation, shown_.sine_grazing,
                                            static_cast<uint32_t>(shown_.object), shown_.hits));
    }

    bool isSelected(uint bin, uint64_t energy) const {
        const auto object = static_cast<uint32_t>(shown_.object);
        const uint8_t path = object & behind_walls   ? types::SonarTruth::through_wall
                             : object & rung_in_wall ? types::SonarTruth::rung
                                                     : uint8_t{0};
        return selection_->keeps({object & ~(behind_walls | rung_in_wall), static_cast<uint32_t>(shown_.object >> 32),
                                  path, shown_.beam, bin, energy, shown_.sine_elevation, shown_.sine_grazing});
    }

    TruthSink truth_;
    size_t channels_, beam_numbers_;
    uint64_t* all_;
    EchoSelection* selection_;
    CellTruth shown_;
};

/** Adds the echoes of a batch to the sums, and to the truth where it is recorded. */
template <class Estimator>
void sumBatch(const EchoRules& rules, const Cells& cells, const Covered& covered, const EchoSums& to) {
    const auto getBeam = [&](int i) { return static_cast<uint>(cells.beam[i] - to.first_beam); };
    if (!to.truth) {
        Estimator estimator(rules, to.sums);
        for (int i = 0; i < cells.count; ++i)
            estimator.depositCell(getFootprint(covered, i), getBeam(i), covered.strength_range[i]);
        return;
    }
    TruthEstimator<Estimator> estimator(rules, to.sums, to.truth);
    for (int i = 0; i < cells.count; ++i) {
        const double x = cells.normal_x[i], y = cells.normal_y[i], z = cells.normal_z[i];
        const double facing = (x * cells.cos_az[i] + y * cells.sin_az[i]) * cells.cos_el[i] + z * cells.sin_el[i];
        const double up = rules.looks_down ? -cells.cos_az[i] * cells.cos_el[i] : cells.sin_el[i];
        estimator.setCell({cells.object[i], cells.hits[i], static_cast<uint32_t>(cells.beam[i]), up,
                           abs(facing) / sqrt(x * x + y * y + z * z)});
        estimator.depositCell(getFootprint(covered, i), getBeam(i), covered.strength_range[i]);
    }
}

/** sumBatch() in versions for wide vectors. */
#define INSONIFY_ESTIMATE(name, Estimator)                                                                  \
    INSONIFY_VECTOR_CLONES __attribute__((flatten)) void name(const EchoRules& rules, const Cells& cells,   \
                                                              const Covered& covered, const EchoSums& to) { \
        sumBatch<Estimator>(rules, cells, covered, to);                                                     \
    }

/** Several numbers that are processed together. */
using Bins8 = double __attribute__((vector_size(bins_at_once * sizeof(double))));

/** The same in whole quanta. */
using Counts = int64_t __attribute__((vector_size(bins_at_once * sizeof(int64_t))));

inline Bins8 min(Bins8 a, double b) { return a < b ? a : Bins8{} + b; }
inline Bins8 max(Bins8 a, double b) { return a > b ? a : Bins8{} + b; }
inline Bins8 abs(Bins8 a) { return a < 0.0 ? -a : a; }
inline Bins8 load(const double* from) {
    Bins8 bins;
    std::memcpy(&bins, from, sizeof bins);
    return bins;
}

/** Energies of footprints: as deposit.glsl with HAVE_PHYSICAL, several bins at once. */
struct PhysicalBins : Bins {
    static constexpr Features features{Feature::Physical};
    using Bins::Bins;

    void depositCell(const Footprint& cell, uint beam, double strength_range) {
        if (!(cell.near_end > cell.far_end && strength_range >= 0.0)) return;
        uint bin = findBin(cell.near_end);
        while (bin > 0u && edges[bin] < cell.near_end) --bin;
        while (edges[bin + 1u] >= cell.near_end) ++bin;
        uint64_t* of_beam = sums + beam * beam_sums;
        if (cell.limb > 0.0)
            for (; edges[bin] > cell.far_end; bin += bins_at_once) addLimbBins(cell, strength_range, bin, of_beam);
        else
            for (; edges[bin] > cell.far_end; bin += bins_at_once) addBins(cell, strength_range, bin, of_beam);
    }

private:
    using real = Bins8;
#include "shaders/trapezoid.glsl"

    void addBins(const Footprint& cell, double strength_range, uint first, uint64_t* of_beam) {
        const Bins8 above = max(min(load(edges + first), cell.near_end), cell.far_end);
        const Bins8 below = max(min(load(edges + first + 1), cell.near_end), cell.far_end);
        const Bins8 to_above = trapezoidShare(cell, above - cell.centre);
        const Bins8 share =
            (above < cell.nearest ? to_above : Bins8{} + 0.5) - trapezoidShare(cell, below - cell.centre);
        add(partEnergy(cell, strength_range, share, load(middles + first), above, below), of_beam + first);
    }

    void addLimbBins(const Footprint& cell, double strength_range, uint first, uint64_t* of_beam) {
        const Bins8 above = max(min(load(edges + first), cell.near_end), cell.far_end);
        const Bins8 below = max(min(load(edges + first + 1), cell.near_end), cell.far_end);
        const Bins8 cut_off =
            above < cell.nearest ? Bins8{} : 0.5 - trapezoidShare(cell, getPlace(cell, above) - cell.centre);
        const Bins8 share = cut_off + limbShare(cell, above) - limbShare(cell, below);
        add(limbEnergy(cell, strength_range, share, load(middles + first), above, below), of_beam + first);
    }

    static void add(Bins8 amounts, uint64_t* to) {
        Counts counts;
        std::memcpy(&counts, to, sizeof counts);
        // Signed, because there is an instruction for it.
        counts += __builtin_convertvector(min(amounts, 1048576.0) * quanta_per_unit + 0.5, Counts);
        std::memcpy(to, &counts, sizeof counts);
    }
};

INSONIFY_ESTIMATE(sumPhysical, PhysicalBins)

#define HAVE_PHYSICAL
#define HAVE_NEAREST
struct NearestBins : Bins {
    static constexpr Features features{Feature::Physical, Feature::Nearest};
    using Bins::Bins;
    void addToBin(uint beam, uint bin, double amount, double) const { sums[beam * beam_sums + bin] += quanta(amount); }
#include "shaders/deposit.glsl"
};
#undef HAVE_NEAREST
#undef HAVE_PHYSICAL

INSONIFY_ESTIMATE(sumNearest, NearestBins)

struct MeanBins : Bins {
    using Bins::Bins;
    void addToBin(uint beam, uint bin, double amount, double weight) const {
        uint64_t* cell = sums + beam * beam_sums + 2 * size_t{bin};
        cell[0] += quanta(amount);
        cell[1] += quanta(weight);
    }
};

#define HAVE_CERQUEIRA2017
struct CerqueiraBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#define HAVE_PUBLISHED
struct PublishedBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Published};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#define HAVE_ABSORPTION
struct AbsorbingPublishedBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Published, Feature::Absorption};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#undef HAVE_PUBLISHED
struct AbsorbingBins : MeanBins {
    static constexpr Features features{Feature::Cerqueira2017, Feature::Absorption};
    using MeanBins::MeanBins;
#include "shaders/deposit.glsl"
};
#undef HAVE_ABSORPTION
#undef HAVE_CERQUEIRA2017

INSONIFY_ESTIMATE(sumMeans, CerqueiraBins)
INSONIFY_ESTIMATE(sumAbsorbingMeans, AbsorbingBins)
INSONIFY_ESTIMATE(sumPublished, PublishedBins)
INSONIFY_ESTIMATE(sumAbsorbingPublished, AbsorbingPublishedBins)

constexpr EstimatorEntry entries[] = {
    {PhysicalBins::features, sumPhysical},
    {NearestBins::features, sumNearest},
    {Features{Feature::Physical, Feature::Nearest, Feature::Jitter}, sumNearest},  // at a random point
    {CerqueiraBins::features, sumMeans},
    {AbsorbingBins::features, sumAbsorbingMeans},
    {PublishedBins::features, sumPublished},
    {AbsorbingPublishedBins::features, sumAbsorbingPublished},
};

}  // namespace

std::span<const EstimatorEntry> estimators() { return entries; }

}  // namespace insonify::sonar
