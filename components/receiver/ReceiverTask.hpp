#pragma once
#include <optional>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/receiver/Receiver.hpp"
#include "types/RecurringDiagnostic.hpp"
#include "types/Sonar.hpp"
#include "types/SonarSettings.hpp"

namespace insonify::receiver {

/** A sonar's receiver: amplifies what reaches it, echoes and noise alike, and gives it out by a law: one ping out for
 *  each ping in, with its time unchanged.
 *
 *  It comes after the noise. A ping whose bins are below 0, and so no intensities, leads to RunTimeError, from which
 *  the next good one recovers. With nothing to do the ping itself is passed on, not a copy. Properties that are set
 *  hold from the next ping on. Pings that are silenced whole, saturate, or are all code 0 are told of: once, and
 *  again only after they have been good. */
class ReceiverTask final : public framework::TaskContext, public framework::Divisible {
public:
    using TaskContext::TaskContext;

    framework::Properties<ReceiverConfig> config{this};
    framework::InputPort<types::SonarPtr> intensity{this, "intensity", "linear intensities, with their noise",
                                                    framework::Need::Required, types::reaching_receiver};
    framework::OutputPort<types::SonarPtr> ping{this, "ping", "the same ping as the receiver gives it out",
                                                types::left_receiver};

    framework::InputPort<types::SonarSettings> settings{
        this, "settings", "whose gain_db this receiver takes over, from the next ping on", framework::Need::Optional};

    std::vector<std::string> notices() const override;

private:
    bool configureHook() override;
    bool propertiesHook() override { return configureHook(); }
    void updateHook() override;
    void errorHook() override { updateHook(); }
    void takeSettings();
    types::SonarPtr received(const types::SonarPtr& sample);

    void judge(const types::Sonar& intensities, const types::Sonar& received);

    std::optional<Receiver> receiver_;
    types::RecurringDiagnostic flawed_;
    framework::SamplePool<types::Sonar> pool_;
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::receiver
