#include "components/sonar/BinLevels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/sonar/Acoustics.hpp"
#include "types/Angle.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {
namespace {

constexpr double floor_db = -3000;
constexpr double largest = static_cast<double>(std::numeric_limits<float>::max());

float intensity(double accumulated, double factor, double ceiling) {
    return accumulated > 0 ? static_cast<float>(std::min(accumulated * factor, ceiling)) : 0.0f;
}

/** What the echo of medium sand, seen face on, accumulates in the cell of one beam and one bin at range r [sr]. */
double sandCell(const SonarConfig& config, const BinGrid& grid, double r) {
    return std::pow(10, types::Material{}.lambert_db / 10.0) * types::radians(config.beamWidthDeg()) * grid.bin_width /
           r;
}

float levelOf(double accumulated, double offset_db) {
    const double level = accumulated > 0 ? 10 * std::log10(accumulated) + offset_db : floor_db;
    return static_cast<float>(std::max(level, floor_db));
}

}  // namespace

BinLevels::BinLevels(const SonarConfig& config, const BinGrid& grid)
    : output_(config.output),
      ceiling_(config.gain ? 1 : largest),
      level_db_(static_cast<size_t>(grid.bin_count)),
      factor_(level_db_.size(), 1.0) {
    if (config.model == Model::Cerqueira2017) {
        std::fill(factor_.begin(), factor_.end(), 2 * config.gain.value_or(0.5));
        return;
    }
    if (output_ == Output::ReceivedLevelDb) source_level_db_ = config.source_level_db;
    const Absorption absorption = makeAbsorption(config);
    for (int j = 0; j < grid.bin_count; ++j) {
        const double r = grid.centre(j);
        if (config.gain) {
            factor_[static_cast<size_t>(j)] =
                2 * *config.gain / sandCell(config, grid, r) * std::pow(10, -2 * absorption.db_per_m * r / 10);
            continue;
        }
        const double gain = config.tvg ? tvgDb(*config.tvg, r) : 0;
        const double level = gain - 20 * std::log10(r) - 2 * absorption.db_per_m * r;
        level_db_[static_cast<size_t>(j)] = level;
        factor_[static_cast<size_t>(j)] = std::pow(10, level / 10);
    }
}

void BinLevels::apply(std::span<const double> accumulated, std::span<float> bins) const {
    for (size_t j = 0; j < bins.size(); ++j)
        bins[j] = output_ == Output::Intensity ? intensity(accumulated[j], factor_[j], ceiling_)
                                               : levelOf(accumulated[j], source_level_db_ + level_db_[j]);
}

}  // namespace insonify::sonar
