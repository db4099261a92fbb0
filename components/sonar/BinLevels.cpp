#include "components/sonar/BinLevels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/sonar/Acoustics.hpp"

namespace insonify::sonar {
namespace {

constexpr double largest = static_cast<double>(std::numeric_limits<float>::max());

}  // namespace

BinLevels::BinLevels(const SonarConfig& config, const BinGrid& grid)
    : level_db_(static_cast<size_t>(grid.bin_count)), factor_(level_db_.size(), 1.0) {
    if (config.model == Model::Cerqueira2017) return;
    const Absorption absorption = makeAbsorption(config);
    for (int j = 0; j < grid.bin_count; ++j) {
        const double r = grid.centre(j);
        const double level = -20 * std::log10(r) - 2 * absorption.db_per_m * r;
        level_db_[static_cast<size_t>(j)] = level;
        factor_[static_cast<size_t>(j)] = std::pow(10, level / 10);
    }
}

void BinLevels::apply(std::span<const double> accumulated, std::span<float> bins) const {
    for (size_t j = 0; j < bins.size(); ++j)
        bins[j] = accumulated[j] > 0 ? static_cast<float>(std::min(accumulated[j] * factor_[j], largest)) : 0.0f;
}

}  // namespace insonify::sonar
