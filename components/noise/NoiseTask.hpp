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
#include "types/RecurringDiagnostic.hpp"
#include "types/Sonar.hpp"

namespace insonify::noise {

/** Puts speckle and background noise into pings: one ping out for each ping in, with its time unchanged.
 *
 *  It comes before the receiver, whose gain raises noise and echoes alike. The bins must be linear intensities: a ping
 *  with bins below 0 leads to RunTimeError, from which the next good one recovers. The same seed and the same ping
 *  times give the same noise, in a replay too; each task of a deployment has a seed of its own, unless one is written.
 *  Without any noise the ping itself is passed on, not a copy. Properties that are set hold from the next ping on. A
 *  warning reports a ping whose loudest echo is below the mean of the added noise: once, and again only after echoes
 *  have stood out. */
class NoiseTask final : public framework::TaskContext, public framework::Divisible {
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
    /** Tells of a ping whose echoes are all below the mean of the noise that is added. */
    void judge(const types::Sonar& ping);

    std::optional<Noise> noise_;
    framework::SamplePool<types::Sonar> pool_;
    uint64_t clamped_ = 0;
    types::RecurringDiagnostic buried_;
};

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::noise
