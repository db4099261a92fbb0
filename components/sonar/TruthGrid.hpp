#pragma once
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "components/sonar/RenderPlan.hpp"
#include "components/sonar/ThreadPool.hpp"
#include "components/sonar/TruthTable.hpp"

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

}  // namespace insonify::sonar
