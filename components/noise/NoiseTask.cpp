#include "components/noise/NoiseTask.hpp"

namespace insonify::noise {

bool NoiseTask::configureHook() {
    noise_.emplace(*config);
    return true;
}

bool NoiseTask::startHook() {
    clamped_ = 0;
    return true;
}

void NoiseTask::updateHook() {
    types::SonarPtr ping;
    if (!clean.readNew(ping)) return;
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
    pool_.stock(*result);
    return result;
}

}  // namespace insonify::noise
