// Seeds and extreme shapes of noise.
#include "components/noise/Noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/study/stability/StabilityStudy.hpp"

namespace insonify::study {
namespace {

/** Returns a ping whose bins are all 1. */
types::Sonar items(int64_t microseconds, uint32_t beams, uint32_t bins) {
    types::Sonar ping;
    ping.time.microseconds = microseconds;
    ping.beam_count = beams;
    ping.bin_count = bins;
    ping.bins.assign(size_t{beams} * bins, 1.0f);
    return ping;
}

types::Sonar noisy(const noise::NoiseConfig& config, const types::Sonar& clean) {
    types::Sonar result;
    noise::Noise(config).add(clean, result);
    return result;
}

/** Returns the correlation of the first two beams. */
double correlation(const types::Sonar& ping) {
    const size_t n = ping.bin_count;
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (size_t i = 0; i < n; ++i) {
        const double a = ping.bins[i], b = ping.bins[n + i];
        x += a, y += b, xx += a * a, yy += b * b, xy += a * b;
    }
    const auto count = static_cast<double>(n);
    return (xy - x * y / count) / std::sqrt((xx - x * x / count) * (yy - y * y / count));
}

Outcome seeds() {
    constexpr uint32_t bins = 20000;
    int wrong = 0;
    double worst = 0;
    noise::NoiseConfig config;
    config.speckle.emplace();
    for (const uint64_t seed : {uint64_t{0}, uint64_t{1}, ~uint64_t{0}}) {
        config.seed = seed;
        const types::Sonar first = noisy(config, items(5, 2, bins));
        wrong += noisy(config, items(5, 2, bins)).bins != first.bins;
        wrong += noisy(config, items(6, 2, bins)).bins == first.bins;
        worst = std::max(worst, std::abs(correlation(first)));
    }
    wrong += worst > 4 / std::sqrt(bins);
    return {{{"samples", bins}},
            fmt::format("seeds 0, 1 and 2^64 - 1: the same again, another ping differs, beams correlate by at most "
                        "{:.1e} (bound {:.1e})",
                        worst, 4 / std::sqrt(bins)),
            worst,
            wrong ? Verdict::Fail : Verdict::Pass};
}

Outcome extremeShapes() {
    noise::NoiseConfig config;
    const auto drawn = [&](double shape) {
        config.speckle = {.law = noise::SpeckleLaw::K, .shape = shape};
        return noisy(config, items(7, 64, 1000)).bins;
    };
    const std::vector<float> patchy = drawn(1e-3);
    std::vector<float> even = drawn(1e6);
    const bool finite = std::ranges::all_of(patchy, [](float bin) { return bin >= 0 && std::isfinite(bin); });
    const float maximum = std::ranges::max(patchy);
    std::ranges::sort(even);
    double distance = 0;
    const auto count = static_cast<double>(even.size());
    for (size_t i = 0; i < even.size(); ++i)
        distance = std::max(distance, std::abs(-std::expm1(-double{even[i]}) - (static_cast<double>(i) + 0.5) / count));
    const double bound = 1.63 / std::sqrt(count);
    return {{{"samples", count}},
            fmt::format("shape 1e-3: finite, the largest of 64,000 is {:.0f} times the mean; 1e6: off the exponential "
                        "law by {:.1e} (bound {:.1e})",
                        maximum, distance, bound),
            distance,
            finite && maximum > 100 && distance < bound ? Verdict::Pass : Verdict::Fail};
}

}  // namespace

std::vector<StabilityCase> noiseCases() {
    return {{47, "Seeds 0 and 2^64 - 1", "identical again; beams uncorrelated, below 4 / sqrt(n)", seeds},
            {48, "K statistics of shape 1e-3 and 1e6", "finite with an extreme tail; exponential", extremeShapes}};
}

}  // namespace insonify::study
