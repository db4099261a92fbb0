#include "components/sonar/beams/BinGrid.hpp"

#include <algorithm>
#include <cmath>

#include "types/Check.hpp"
#include "types/geometry/VectorMath.hpp"

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

namespace {

INSONIFY_VECTOR_CLONES void convolve(const float* echoes, std::span<const float> taps, float* __restrict bins,
                                     size_t count) {
    size_t i = 0;
    for (; i + 4 <= taps.size(); i += 4) {
        const float* from = echoes + i;
        const float a = taps[i], b = taps[i + 1], c = taps[i + 2], d = taps[i + 3];
        for (size_t j = 0; j < count; ++j)
            bins[j] += (a * from[j] + b * from[j + 1]) + (c * from[j + 2] + d * from[j + 3]);
    }
    for (; i < taps.size(); ++i)
        for (size_t j = 0; j < count; ++j) bins[j] += taps[i] * echoes[i + j];
}

}  // namespace

RangeResponse::RangeResponse(const acoustics::Pulse& pulse, const BinGrid& grid) {
    const double reach = pulse.extent(floor_db) / grid.bin_width + 0.5;
    const int margin = std::clamp(static_cast<int>(std::ceil(reach)) - 1, 0, grid.bin_count - 1);
    for (int m = -margin; m <= margin; ++m)
        taps_.push_back(static_cast<float>(pulse.mean((m - 0.5) * grid.bin_width, (m + 0.5) * grid.bin_width)));
}

void RangeResponse::spread(std::span<const float> echoes, std::span<float> bins) const {
    INSONIFY_CHECK(echoes.size() == bins.size() + 2 * margin(), echoes.size(), bins.size(), margin());
    std::ranges::fill(bins, 0.0f);
    convolve(echoes.data(), taps_, bins.data(), bins.size());
}

bool isShort(const acoustics::Pulse& pulse, const BinGrid& grid) { return pulse.resolution() < grid.bin_width / 2; }

double rangeCell(const SonarConfig& config) {
    const BinGrid grid = makeBinGrid(config);
    const double bin = grid.bin_width;
    return config.pulse ? std::max(bin, acoustics::Pulse(*config.pulse, grid.speed_of_sound).resolution()) : bin;
}

}  // namespace insonify::sonar
