#include "components/study/RayTimes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "components/study/EmbreeCaster.hpp"

namespace insonify::study {
namespace {

/** Of `pings` calls after a first one, shortest first [ms]. */
template <class Work>
std::vector<double> sortedTimes(int pings, const Work& work) {
    using Clock = std::chrono::steady_clock;
    work();
    std::vector<double> times;
    for (int i = 0; i < pings; ++i) {
        const Clock::time_point start = Clock::now();
        work();
        times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    std::ranges::sort(times);
    return times;
}

double share(const std::vector<double>& sorted, double part) {
    return sorted[static_cast<size_t>(std::ceil(part * static_cast<double>(sorted.size()))) - 1];
}

}  // namespace

RayTimes timeRays(const sonar::SonarConfig& config, const types::Snapshot& scene, int pings) {
    EmbreeCaster caster(scene);
    caster.prepare(config);
    RayTimes result;
    result.rays = static_cast<size_t>(config.rows()) * static_cast<size_t>(config.columnsPerBeam() * config.beams());
    const auto alone = sortedTimes(pings, [&] { result.met = caster.castOnly(scene.sonar); });
    std::vector<float> energies;
    const auto whole = sortedTimes(pings, [&] { caster.render(scene.sonar, energies); });
    result.alone_median_ms = share(alone, 0.5), result.alone_p99_ms = share(alone, 0.99);
    result.ping_median_ms = share(whole, 0.5), result.ping_p99_ms = share(whole, 0.99);
    return result;
}

}  // namespace insonify::study
