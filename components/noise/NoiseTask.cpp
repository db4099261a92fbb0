#include "components/noise/NoiseTask.hpp"

#include "components/noise/Noise.hpp"

namespace insonify::noise {

bool NoiseTask::startHook() {
    clamped_ = 0;
    return true;
}

void NoiseTask::updateHook() {
    types::SonarPtr ping;
    if (clean.readNew(ping)) noisy.write(withNoise(ping));
}

types::SonarPtr NoiseTask::withNoise(const types::SonarPtr& ping) {
    if (!config->speckle && !config->additive) return ping;
    const auto result = pool_.take();
    clamped_ += addNoise(*config, *ping, *result);
    pool_.stock(*result);
    return result;
}

}  // namespace insonify::noise
