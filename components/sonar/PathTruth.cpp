#include "components/sonar/PathTruth.hpp"

#include <algorithm>

#include "components/sonar/TruthGrid.hpp"

namespace insonify::sonar {

PathTruth::PathTruth(const RenderPlan& plan, size_t bin_count)
    : beams_of_cells_(beamsOfCells(plan)), sum_count_(bin_count), bin_count_(static_cast<size_t>(plan.grid.bin_count)) {
    for (std::vector<uint64_t>& sums : sums_) sums.resize(plan.cells.size() * sum_count_);
    for (std::vector<double>& energies : energies_) energies.resize(plan.beams.size() * bin_count_);
}

void PathTruth::begin() {
    for (std::vector<uint64_t>& sums : sums_) std::ranges::fill(sums, 0);
    for (std::vector<double>& energies : energies_) std::ranges::fill(energies, 0.0);
}

void PathTruth::take(size_t cell, std::span<const float> direct, const BinLevels& levels, double quantum) {
    const int32_t beam = beams_of_cells_.empty() ? static_cast<int32_t>(cell) : beams_of_cells_[cell];
    if (beam < 0) return;
    const size_t first = static_cast<size_t>(beam) * bin_count_, per_bin = sum_count_ / bin_count_;
    knows_direct_ = !direct.empty();
    for (size_t j = 0; j < direct.size(); ++j) energies_[0][first + j] += double{direct[j]};
    for (size_t path = 0; path < sums_.size(); ++path)
        for (size_t j = 0; j < sum_count_; ++j) {
            const uint64_t sum = sums_[path][cell * sum_count_ + j];
            if (sum > 0)
                energies_[path + 1][first + j / per_bin] +=
                    double{levels.intensity(j, static_cast<double>(sum) * quantum)};
        }
}

void PathTruth::tell(types::SonarTruth& truth) const {
    for (size_t beam = 0; beam < truth.beam_count; ++beam) {
        size_t last = 0;
        for (size_t j = 0; j < bin_count_; ++j) {
            const size_t at = beam * bin_count_ + j;
            uint8_t loudest = 0;
            for (uint8_t path = 1; path < energies_.size(); ++path)
                if (energies_[path][at] > energies_[loudest][at]) loudest = path;
            if (!knows_direct_ && truth.hits[at] > 0) loudest = 0;
            truth.path[at] = loudest;
            if (loudest > 0 || truth.hits[at] > 0) last = j;
        }
        for (size_t j = 0; j < bin_count_; ++j) {
            const size_t at = beam * bin_count_ + j;
            truth.shadow[at] = j < last && truth.path[at] == 0 && truth.hits[at] == 0;
        }
    }
}

}  // namespace insonify::sonar
