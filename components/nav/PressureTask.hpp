#pragma once
#include <optional>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/nav/Motion.hpp"
#include "components/nav/Pressure.hpp"

namespace insonify::nav {

/** A pressure gauge, from the poses of the body.
 *
 *  Input: `pose`, body in the world. Outputs, at the time of the pose: `pressure`, absolute; the depth in the same
 *  water as Rock's `depth_samples`. The same seed and poses give the same errors; a replay repeats them if it starts
 *  with the first pose. A pose that is not finite leads to RunTimeError; the next valid pose recovers from it. */
class PressureTask final : public framework::TaskContext, public framework::Divisible {
public:
    using TaskContext::TaskContext;

    framework::Properties<PressureConfig> config{this};
    framework::InputPort<types::Pose> pose{this, "pose", "body in the world: x north, y west, z up"};
    framework::OutputPort<types::Pressure> pressure{this, "pressure", "absolute, of air and water"};
    framework::OutputPort<types::Pose> depth_samples{this, "depth_samples", "z of the gauge, as Rock's"};

private:
    bool configureHook() override;
    bool startHook() override { return configureHook(); }
    void updateHook() override;
    void errorHook() override { updateHook(); }

    Cadence cadence_;
    std::optional<PressureGauge> gauge_;
};

}  // namespace insonify::nav
