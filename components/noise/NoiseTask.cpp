#include "components/noise/NoiseTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace insonify::noise {
namespace {

/** Returns a warning with the distance of a ping's loudest bin below a mean intensity. */
std::string burialText(const types::Sonar& ping, size_t loudest, double background) {
    const double echo_db = 10 * std::log10(static_cast<double>(ping.bins[loudest]));
    const double noise_db = 10 * std::log10(background);
    const size_t beam = loudest / ping.bin_count, bin = loudest % ping.bin_count;
    return fmt::format(
        "the echoes are below the noise: the loudest, {:.4g} dB at {:.4g} m in beam {}, is {:.3g} dB below the mean of "
        "the noise, {:.4g} dB; raise the source level, or lower the noise",
        echo_db, ping.binStart(static_cast<double>(bin) + 0.5), beam, noise_db - echo_db, noise_db);
}

}  // namespace

bool NoiseTask::configureHook() {
    noise_.emplace(*config);
    return true;
}

bool NoiseTask::startHook() {
    clamped_ = 0;
    buried_ = {};
    return true;
}

void NoiseTask::updateHook() {
    types::SonarPtr ping;
    if (!clean.readNew(ping)) return;
    if (environment().rehearsing) return noisy.write(ping);
    if (const char* diagnostic = ping->notIntensities())
        return error(std::string("clean: ") + diagnostic +
                     "; connect a sonar's ping here, and a receiver after the noise");
    if (state() == framework::TaskState::RunTimeError) recover();
    noisy.write(withNoise(ping));
}

types::SonarPtr NoiseTask::withNoise(const types::SonarPtr& ping) {
    if (config->isNone()) return ping;
    const auto result = pool_.take();
    clamped_ += noise_->add(*ping, *result);
    if (noise_->background() > 0) require(*ping);
    pool_.stock(*result);
    return result;
}

void NoiseTask::require(const types::Sonar& ping) {
    float maximum = 0;
    for (const float bin : ping.bins) maximum = bin > maximum ? bin : maximum;
    if (maximum == 0) return;  // the sonar reports an empty ping
    const bool is_buried = static_cast<double>(maximum) < noise_->background();
    if (!buried_.isDue(is_buried)) return;
    const auto loudest = static_cast<size_t>(std::ranges::find(ping.bins, maximum) - ping.bins.begin());
    warn(burialText(ping, loudest, noise_->background()));
}

void registerTasks(framework::Registry& registry) {
    registry.add<NoiseTask>("noise::NoiseTask", "puts speckle and background noise into pings");
}

}  // namespace insonify::noise
