#include <fmt/format.h>

#include "components/sonar/plan/Effect.hpp"
#include "components/sonar/rays/RayPaths.hpp"
#include "types/Angle.hpp"

namespace insonify::sonar {
namespace {

std::string speedWords(const Omitted& what, const BinGrid& /*grid*/) {
    return fmt::format("motion_in_ping is false; from {:.2g} m/s on it moves echoes by more than half a bin",
                       what.value);
}

/** Sonar and objects that move while sound travels (ACOUSTICS.md 5.20). RayPaths computes the sound paths. */
class MotionInPing final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (!plan.config.motion_in_ping)
            return leaveOut(plan, {.effect = "motion within a ping",
                                   .reason = Reason::Approximated,
                                   .value = motionBound(plan.config, plan.grid).speed,
                                   .words = speedWords});
        plan.effect_features.emplace_back("motion_in_ping");
        return true;
    }
    std::vector<std::string> features() const override { return {"motion_in_ping"}; }
    void note(const RenderPlan& plan, const types::Geometry& /*geometry*/,
              std::vector<std::string>& notices) const override {
        if (!plan.config.motion_in_ping) return;
        const MotionBound bound = motionBound(plan.config, plan.grid);
        notices.push_back(
            fmt::format("motion within a ping is simulated from {:.2g} m/s or {:.2g} deg/s; below that it is less than "
                        "half a bin and half a beam",
                        bound.speed, types::degrees(bound.turn)));
    }
};

}  // namespace

bool followsMotion(const SonarConfig& config) { return config.motion_in_ping; }

const Effect& motionInPing() { return only<MotionInPing>(); }

}  // namespace insonify::sonar
