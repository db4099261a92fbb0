#pragma once
#include <optional>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/receiver/Receiver.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarSettings.hpp"
#include "types/text/Notice.hpp"

namespace insonify::receiver {

/** A sonar's receiver: amplifies echoes and noise alike, and outputs them by a law. One ping out for each ping in, with
 *  its time unchanged.
 *
 *  The task belongs after the noise. A ping with bins below 0, which are no intensities, leads to RunTimeError; the
 *  next valid ping recovers from it. A receiver without effect passes on the ping itself, not a copy. Changed
 *  properties apply from the next ping. A warning reports pings that are blanked completely, saturate, or contain only
 *  code 0: once, and again only after good pings. */
class ReceiverTask final : public framework::TaskContext, public framework::Divisible, public framework::Adjustable {
public:
    using TaskContext::TaskContext;

    framework::Properties<ReceiverConfig> config{this};
    framework::InputPort<types::SonarPtr> intensity{this, "intensity", "linear intensities, with their noise",
                                                    framework::Need::Required, types::reaching_receiver};
    framework::OutputPort<types::SonarPtr> ping{this, "ping", "the ping as the receiver outputs it",
                                                types::left_receiver};

    framework::InputPort<types::SonarSettings> settings{
        this, "settings", "settings whose gain_db applies from the next ping", framework::Need::Optional};

    types::Notices notices() const override;

private:
    bool configureHook() override;
    bool propertiesHook() override { return configureHook(); }
    void updateHook() override;
    void errorHook() override { updateHook(); }
    void readSettings();
    types::SonarPtr received(const types::SonarPtr& sample);

    void evaluate(const types::Sonar& intensities, const types::Sonar& received);

    std::optional<Receiver> receiver_;
    types::RecurringDiagnostic flawed_;
    framework::SamplePool<types::Sonar> pool_;
};

/** Registers the tasks of this folder. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::receiver
