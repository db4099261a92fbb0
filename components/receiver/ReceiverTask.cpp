#include "components/receiver/ReceiverTask.hpp"

namespace insonify::receiver {

std::vector<std::string> ReceiverTask::notices() const {
    return receiver_ ? receiver_->notices() : std::vector<std::string>{};
}

bool ReceiverTask::configureHook() {
    receiver_.emplace(*config);
    return true;
}

void ReceiverTask::updateHook() {
    types::SonarPtr sample;
    if (!intensity.readNew(sample)) return;
    if (const char* diagnostic = sample->notIntensities())
        return error(std::string("intensity: ") + diagnostic + "; connect the noise, or a sonar's ping");
    if (state() == framework::TaskState::RunTimeError) recover();
    ping.write(received(sample));
}

types::SonarPtr ReceiverTask::received(const types::SonarPtr& sample) {
    if (receiver_->isNeutral()) return sample;
    const auto result = pool_.take();
    receiver_->receive(*sample, *result);
    pool_.stock(*result);
    return result;
}

}  // namespace insonify::receiver
