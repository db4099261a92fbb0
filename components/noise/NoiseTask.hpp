#pragma once
#include <optional>

#include "components/framework/Offers.hpp"
#include "components/framework/Operation.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/noise/Noise.hpp"
#include "types/samples/Sonar.hpp"
#include "types/text/Notice.hpp"

namespace insonify::noise {

/** Adds speckle and background noise to pings: one ping out for each ping in, with its time unchanged.
 *
 *  The task belongs before the receiver, whose gain amplifies noise and echoes alike. The bins must be linear
 *  intensities. A ping with bins below 0 leads to RunTimeError; the next valid ping recovers from it. The same seed and
 *  the same ping times give the same noise, in a replay too. Each task of a deployment has its own seed, unless a seed
 *  is given. Without any noise the ping itself is passed on, not a copy. Changed properties apply from the next ping. A
 *  warning reports a ping whose loudest echo is below the mean of the added noise: once, and again only after pings
 *  with louder echoes. */
class NoiseTask final : public framework::TaskContext, public framework::Divisible, public framework::Adjustable {
public:
    using TaskContext::TaskContext;

    framework::Properties<NoiseConfig> config{this};
    framework::InputPort<types::SonarPtr> clean{this, "clean", "ping without noise, linear intensities",
                                                framework::Need::Required, types::reaching_receiver};
    framework::OutputPort<types::SonarPtr> noisy{this, "noisy", "the same ping with noise"};
    framework::Operation<uint64_t()> clamped{this, "clamped", "gaussian factors below 0, clamped since start",
                                             [this] { return clamped_; }};

private:
    bool configureHook() override;
    bool propertiesHook() override { return configureHook(); }
    bool startHook() override;
    void updateHook() override;
    void errorHook() override { updateHook(); }
    types::SonarPtr withNoise(const types::SonarPtr& ping);
    /** Warns when all echoes of a ping are below the mean of the added noise. */
    void require(const types::Sonar& ping);

    std::optional<Noise> noise_;
    framework::SamplePool<types::Sonar> pool_;
    uint64_t clamped_ = 0;
    types::RecurringDiagnostic buried_;
};

/** Registers the tasks of this folder. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::noise
