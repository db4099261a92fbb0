#pragma once
#include <array>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/base/ThreadPool.hpp"
#include "components/sonar/bins/BinLevels.hpp"
#include "components/sonar/bins/TruthTable.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::sonar {

/** Returns for each azimuth cell of a plan the beam that shows it. A beam shows the cells up to halfway to its
 *  neighbours. -1 for a cell in sidelobes only. Empty where cells are beams. */
std::vector<int32_t> beamsOfCells(const RenderPlan& plan);

/** The echoes of the water in the beams of a ping, from effects' own sums. A beam has those of the cells that it shows.
 *  All sums are of whole quanta, so that the order of the cells is free. */
class WaterTruth {
public:
    /** `sum_count`: bins of the sums, a multiple of the plan's. `threads`: max number of calls of take() at a time. */
    WaterTruth(const RenderPlan& plan, size_t sum_count, int threads);

    void begin();
    /** Takes all sums of a cell, for samples of `solid_angle` [sr]. Thread-safe. */
    void take(const EchoRules& rules, const uint64_t* sums, size_t cell, double solid_angle, size_t thread);
    /** Returns the energies of a beam's bins, in the quanta of ObjectEcho::energy. */
    std::span<const uint64_t> beam(size_t beam) const { return {&energies_[beam * bin_count_], bin_count_}; }
    /** Returns the intensity of a bin [1/m^2]. `quantum`: of the sums [sr]. */
    double intensity(size_t beam, size_t bin, double quantum) const {
        return static_cast<double>(energies_[beam * bin_count_ + bin]) * quantum * levels_.factor(bin);
    }

private:
    std::vector<int32_t> beams_of_cells_;          ///< Empty: cells are beams.
    size_t bin_count_, per_bin_;                   ///< Bins of a beam; sums of a bin.
    BinLevels levels_;                             ///< Intensities of the beams' bins.
    std::vector<uint64_t> energies_;               ///< [beam][bin], in quanta.
    std::vector<std::vector<float>> intensities_;  ///< Buffer of each thread.
};

/** Transfers the truth of azimuth cells to the truth of a ping's beams: each beam gets that of the cells next to its
 *  bearing. */
class TruthGrid {
public:
    /** `rules`: of the sums. `whole`: each cell is taken once per ping. `threads`: max number of calls at a time. */
    TruthGrid(const RenderPlan& plan, const EchoRules& rules, bool whole, int threads);

    void begin();
    /** Returns the truth of the water, which takes a cell before the grid takes the last part of the cell; null where
     *  no effect has own sums. */
    WaterTruth* water() { return water_ ? &*water_ : nullptr; }
    /** Takes all or a part of the truth of a cell. Thread-safe. */
    void take(size_t cell, const TruthTable& echoes, size_t of, types::SonarTruth& truth);
    /** Completes the truth once all cells are taken. */
    void finish(types::SonarTruth& truth, ThreadPool& threads) const;

private:
    std::span<const uint64_t> waterOf(size_t beam) const {
        return water_ ? water_->beam(beam) : std::span<const uint64_t>();
    }

    std::vector<int32_t> beams_of_cells_;
    size_t beam_count_;
    std::optional<WaterTruth> water_;
    std::optional<TruthTable> gathered_;  ///< Used where the truth of a beam has several parts.
    std::deque<std::mutex> alone_;        ///< One for each such beam.
};

/** The kind of path that contributes most to a bin, and the object of its echo. Sums the cells' energies by kind of
 *  path, for the beams that show the cells. */
class PathTruth {
public:
    /** Values of types::SonarTruth::path, from 1. */
    enum Path { SurfaceOnce = 1, SurfaceTwice, Bounced };

    /** `bin_count`: bins of the sums, a multiple of the plan's. */
    PathTruth(const RenderPlan& plan, size_t bin_count);

    void begin();
    /** Returns the sums of energies via a path: [cell][bin], in quanta. */
    uint64_t* sums(Path path) { return sums_[path - 1].data(); }
    /** Adds an echo via any of the paths, in bin `bin` of the sums of a cell. Thread-safe. */
    void show(size_t cell, size_t bin, const ObjectEcho& echo);
    /** Takes the energies of a cell once all are summed, before they are added to the cell. `direct`: the cell's direct
     *  echoes, empty where their energies are unknown. `quantum`: of the sums [sr]. */
    void take(size_t cell, std::span<const float> direct, const BinLevels& levels, double quantum);
    /** Completes the truth once all cells are taken and the rest of the truth is recorded. A bin shows the truth of its
     *  strongest path. `water`: null: none. `quantum`: of the sums [sr]. */
    void report(types::SonarTruth& truth, const WaterTruth* water, double quantum);

private:
    double energyOfWays(size_t at) const { return energies_[1][at] + energies_[2][at] + energies_[3][at]; }
    /** Returns the path that contributes more to a bin than direct echoes and the water; 0: none. */
    uint8_t loudest(const types::SonarTruth& truth, size_t at, double water) const;
    /** Takes the labels of the mirrors into a bin whose path is reported, and their energies into its share. */
    void completeBin(types::SonarTruth& truth, size_t at, double water) const;

    std::vector<int32_t> beams_of_cells_;  ///< Empty: cells are beams.
    size_t sum_count_, bin_count_;         ///< Bins of a cell; of a beam.
    bool knows_direct_ = false;
    std::array<std::vector<uint64_t>, 3> sums_;
    std::array<std::vector<double>, 4> energies_;  ///< Direct, and via each path: [beam][bin].
    TruthTable shown_;                             ///< Echoes via all paths except the direct one.
    std::deque<std::mutex> alone_;                 ///< One for each beam.
    types::SonarTruth shown_truth_;
};

}  // namespace insonify::sonar
