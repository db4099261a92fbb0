#include "components/sonar/beams/BinGrid.hpp"

#include <algorithm>
#include <cmath>

namespace insonify::sonar {
namespace {

int64_t wholeMicroseconds(double asked, RangeRounding rounding) {
    const double nearest = std::round(asked);
    const bool whole = std::abs(asked - nearest) <= 1e-6;
    const double chosen = whole || rounding == RangeRounding::Exact ? nearest : std::ceil(asked);
    return std::max<int64_t>(1, static_cast<int64_t>(chosen));
}

}  // namespace

BinGrid makeBinGrid(const SonarConfig& config) {
    const double c = static_cast<double>(static_cast<float>(config.speedOfSound()));
    const int intervals = std::max(1, config.published ? config.bin_count - 1 : config.bin_count);
    const double asked_us = config.range / intervals / c * 1e6;
    const int64_t us = wholeMicroseconds(asked_us, config.range_rounding);
    const double width =
        config.range_rounding == RangeRounding::Exact ? config.range / intervals : static_cast<double>(us) * 1e-6 * c;
    return {config.bin_count, us, width, config.range_min, intervals * width, c};
}

}  // namespace insonify::sonar
