#pragma once
// Processing of a batch of cells by an estimator, with or without truth. Include it only in files of estimators.
#include <cmath>

#include "components/sonar/bins/CellDeposit.hpp"
#include "components/sonar/bins/Estimators.hpp"
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
        const int32_t row = shown_.object < 0 ? -1 : truth_.rowOf(beam);
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
    const auto beamOf = [&](int i) { return static_cast<uint>(cells.beam[i] - to.first_beam); };
    if (!to.truth) {
        Estimator estimator(rules, to.sums);
        for (int i = 0; i < cells.count; ++i)
            estimator.depositCell(footprintOf(covered, i), beamOf(i), covered.strength_range[i]);
        return;
    }
    TruthEstimator<Estimator> estimator(rules, to.sums, to.truth);
    for (int i = 0; i < cells.count; ++i) {
        const double x = cells.normal_x[i], y = cells.normal_y[i], z = cells.normal_z[i];
        const double facing = (x * cells.cos_az[i] + y * cells.sin_az[i]) * cells.cos_el[i] + z * cells.sin_el[i];
        const double up = rules.looks_down ? -cells.cos_az[i] * cells.cos_el[i] : cells.sin_el[i];
        estimator.setCell({cells.object[i], cells.hits[i], static_cast<uint32_t>(cells.beam[i]), up,
                           abs(facing) / sqrt(x * x + y * y + z * z)});
        estimator.depositCell(footprintOf(covered, i), beamOf(i), covered.strength_range[i]);
    }
}

/** sumBatch() in versions for wide vectors. */
#define INSONIFY_ESTIMATE(name, Estimator)                                                                  \
    INSONIFY_VECTOR_CLONES __attribute__((flatten)) void name(const EchoRules& rules, const Cells& cells,   \
                                                              const Covered& covered, const EchoSums& to) { \
        sumBatch<Estimator>(rules, cells, covered, to);                                                     \
    }

}  // namespace
}  // namespace insonify::sonar
