#include "components/sonar/beams/RangeResponse.hpp"

#include <algorithm>
#include <cmath>

#include "types/Check.hpp"
#include "types/geometry/VectorMath.hpp"

namespace insonify::sonar {
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
