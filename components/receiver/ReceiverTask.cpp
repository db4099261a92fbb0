#include "components/receiver/ReceiverTask.hpp"

#include <fmt/format.h>

#include <cmath>

namespace insonify::receiver {

types::Notices ReceiverTask::notices() const { return receiver_ ? receiver_->notices() : types::Notices{}; }

bool ReceiverTask::configureHook() {
    receiver_.emplace(*config);
    flawed_ = {};
    return true;
}

void ReceiverTask::readSettings() {
    types::SonarSettings asked;
    if (settings.readNewest(asked, false) != framework::FlowStatus::NewData) return;
    if (std::isfinite(asked.gain_db) && asked.gain_db != config->gain_db) config.change({{"gain_db", asked.gain_db}});
}

void ReceiverTask::updateHook() {
    readSettings();
    types::SonarPtr sample;
    if (!intensity.readNew(sample)) return;
    if (environment().rehearsing) return ping.write(sample);
    if (const char* diagnostic = receiver_->findDiagnostic(*sample))
        return error(std::string("intensity: ") + diagnostic + "; connect the noise, or a sonar's ping");
    if (state() == framework::TaskState::RunTimeError) recover();
    ping.write(received(sample));
}

types::SonarPtr ReceiverTask::received(const types::SonarPtr& sample) {
    if (receiver_->isNeutral()) return sample;
    const auto result = pool_.take();
    receiver_->receive(*sample, *result);
    evaluate(*sample, *result);
    pool_.stock(*result);
    return result;
}

void ReceiverTask::evaluate(const types::Sonar& intensities, const types::Sonar& received) {
    const Receiver::Flaws flaws = receiver_->getFlaws(intensities, received);
    if (flawed_.isDue(flaws.any())) warn(receiver_->text(flaws, intensities));
}

void registerTasks(framework::Registry& registry) {
    registry.add<ReceiverTask>("receiver::ReceiverTask", "amplifies pings (TVG, gain) and outputs them by a law");
}

}  // namespace insonify::receiver
