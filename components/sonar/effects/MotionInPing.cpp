#include "components/sonar/effects/MotionInPing.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/sonar/effects/Effect.hpp"
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

double dopplerCoupling(const SonarConfig& config) {
    if (!config.motion_in_ping || !config.pulse || !config.pulse->chirp_us) return 0;
    return 1e-6 * *config.pulse->chirp_us * config.frequency_khz.value() / config.pulse->bandwidth_khz.value();
}

bool followsMotion(const SonarConfig& config) { return config.motion_in_ping; }

MotionBound motionBound(const SonarConfig& config, const BinGrid& grid) {
    const double flight = 2 * grid.range_max / grid.speed_of_sound;
    const double seconds = std::max(flight, dopplerCoupling(config));
    return {grid.bin_width / (2 * seconds), types::radians(config.beamWidthDeg()) / (2 * flight)};
}

const Effect& motionInPing() { return only<MotionInPing>(); }

}  // namespace insonify::sonar
