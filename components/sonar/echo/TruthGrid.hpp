#pragma once
#include <array>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/ThreadPool.hpp"
#include "components/sonar/echo/BinLevels.hpp"
#include "components/sonar/echo/TruthTable.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::sonar {

/** Of each azimuth cell of a plan, the beam that shows it: one within half whose spacing to its neighbour it lies; -1
 *  for a cell that is heard in sidelobes only. Empty where cells are beams. */
std::vector<int32_t> beamsOfCells(const RenderPlan& plan);

/** The way of what azimuth cells show to the truth of a ping's beams: that of the cells next to its bearing. */
class TruthGrid {
public:
    /** `whole`: each cell comes once a ping. */
    TruthGrid(const RenderPlan& plan, bool whole);

    void begin();
    /** All or a part of what a cell shows. Several threads may give cells at once. */
    void take(size_t cell, const TruthTable& echoes, size_t of, types::SonarTruth& truth);
    /** Once all cells are taken. */
    void finish(types::SonarTruth& truth, ThreadPool& threads) const;

private:
    std::vector<int32_t> beams_of_cells_;
    size_t beam_count_;
    std::optional<TruthTable> gathered_;  ///< Where a beam comes in several parts.
    std::deque<std::mutex> alone_;        ///< Of each beam that does.
};

/** By which way most of what a bin holds has come, and of which object that is: energies of the cells by each, added up
 *  for the beams that show them. */
class PathTruth {
public:
    /** As types::SonarTruth::path tells them, from 1. */
    enum Path { SurfaceOnce = 1, SurfaceTwice, Bounced };

    /** `bin_count`: of the sums, a multiple of the plan's. */
    PathTruth(const RenderPlan& plan, size_t bin_count);

    void begin();
    /** Where the energies by a way are summed: [cell][bin], in quanta. */
    uint64_t* sums(Path path) { return sums_[path - 1].data(); }
    /** Adds an echo by any of the ways, which is in bin `bin` of the sums of a cell. Several threads may do so at once.
     */
    void show(size_t cell, size_t bin, const ObjectEcho& echo);
    /** Once all are summed, and before they are added to the cells: what a cell has heard directly, none where its
     *  energies are not known. `quantum`: of the sums [sr]. */
    void take(size_t cell, std::span<const float> direct, const BinLevels& levels, double quantum);
    /** Once all cells are taken, and the rest of the truth is told. What a bin shows is that of the loudest way. */
    void report(types::SonarTruth& truth);

private:
    std::vector<int32_t> beams_of_cells_;  ///< Empty: they are the beams.
    size_t sum_count_, bin_count_;         ///< Of a cell; of a beam.
    bool knows_direct_ = false;
    std::array<std::vector<uint64_t>, 3> sums_;
    std::array<std::vector<double>, 4> energies_;  ///< Direct, and by each way: [beam][bin].
    TruthTable shown_;                             ///< By all ways but the direct one.
    std::deque<std::mutex> alone_;                 ///< Of each beam.
    types::SonarTruth shown_truth_;
};

}  // namespace insonify::sonar
