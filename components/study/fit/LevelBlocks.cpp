#include "components/study/fit/LevelBlocks.hpp"

#include <algorithm>

namespace insonify::study {
namespace {

constexpr size_t max_beam_blocks = 8, max_slices = 64;
constexpr double response_low = -140, response_high = 60, response_step = 0.25;  // [dB]

LevelBlocks blocksBy(size_t beams, size_t bins, double resolution, const auto& intensity) {
    LevelBlocks blocks{.beam_blocks = std::min(max_beam_blocks, beams), .slices = std::min(max_slices, bins)};
    for (size_t slice = 0; slice < blocks.slices; ++slice)
        blocks.ranges.push_back(resolution * static_cast<double>(bins) * (static_cast<double>(slice) + 0.5) /
                                static_cast<double>(blocks.slices));
    for (size_t block = 0; block < blocks.beam_blocks; ++block)
        for (size_t slice = 0; slice < blocks.slices; ++slice) {
            const size_t b0 = block * beams / blocks.beam_blocks, b1 = (block + 1) * beams / blocks.beam_blocks;
            const size_t k0 = slice * bins / blocks.slices, k1 = (slice + 1) * bins / blocks.slices;
            double sum = 0;
            for (size_t beam = b0; beam < b1; ++beam)
                for (size_t bin = k0; bin < k1; ++bin) sum += intensity(beam, bin);
            blocks.level.push_back(toDb(sum / static_cast<double>((b1 - b0) * (k1 - k0))));
        }
    return blocks;
}

}  // namespace

CodeResponse::CodeResponse(const CodedPing& law) {
    constexpr int quantiles = 128;
    const double maximum = std::pow(2, law.bits) - 1;
    const auto getCode = [&](double intensity) {
        const double exponent = (law.law.law == receiver::CodeLaw::Sqrt ? 0.5 : 1.0) * law.law.gamma;
        const double share = law.law.law == receiver::CodeLaw::Log ? 1 + toDb(intensity) / law.law.dynamic_range_db
                                                                   : std::pow(intensity, exponent);
        return static_cast<float>(std::round(std::clamp(share, 0.0, 1.0) * maximum) / maximum);
    };
    for (double level = response_low; level <= response_high; level += response_step) {
        double sum = 0;
        for (int i = 0; i < quantiles; ++i) {
            const double factor = -std::log((i + 0.5) / quantiles);
            sum += toPower(law.levelDb(getCode(toPower(level) * factor))) / quantiles;
        }
        stated_db_.push_back(toDb(sum));
    }
}

double CodeResponse::operator()(double level_db) const {
    const double place =
        std::clamp((level_db - response_low) / response_step, 0.0, static_cast<double>(stated_db_.size()) - 1.001);
    const auto i = static_cast<size_t>(place);
    const double part = place - static_cast<double>(i);
    return (1 - part) * stated_db_[i] + part * stated_db_[i + 1];
}

LevelBlocks makeBlocks(const CodedPing& ping) {
    return blocksBy(ping.beam_count, ping.bin_count, ping.resolution,
                    [&](size_t beam, size_t bin) { return toPower(ping.levelDb(ping.code(beam, bin))); });
}

LevelBlocks makeBlocks(const types::Sonar& intensities) {
    return blocksBy(intensities.beam_count, intensities.bin_count, intensities.binStart(1),
                    [&](size_t beam, size_t bin) {
                        return static_cast<double>(intensities.bins[beam * intensities.bin_count + bin]);
                    });
}

LevelBlocks computeMean(const std::vector<LevelBlocks>& all) {
    LevelBlocks mean = all.front();
    for (size_t i = 0; i < mean.level.size(); ++i) {
        double sum = 0;
        for (const LevelBlocks& each : all) sum += toPower(each.level[i]);
        mean.level[i] = toDb(sum / static_cast<double>(all.size()));
    }
    return mean;
}

LevelBlocks findMinimum(const std::vector<LevelBlocks>& all) {
    LevelBlocks minimum = all.front();
    for (const LevelBlocks& each : all)
        for (size_t i = 0; i < minimum.level.size(); ++i) minimum.level[i] = std::min(minimum.level[i], each.level[i]);
    return minimum;
}

}  // namespace insonify::study
