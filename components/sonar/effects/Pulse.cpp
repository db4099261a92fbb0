#include <fmt/format.h>

#include "components/sonar/beams/RangeResponse.hpp"
#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

std::string lengthWords(const Omitted& what, const BinGrid& /*grid*/) {
    return fmt::format("the pulse resolves {:.2g} m, under half a bin, {:.2g} m", what.value, what.bound);
}

/** Spread of an echo in range (ACOUSTICS.md 5.10). */
class PulseInRange final : public Effect {
public:
    void check(const SonarConfig& config, types::Diagnostics& diagnostics) const override {
        if (!config.pulse) return;
        if (config.model == Model::Cerqueira2017)
            diagnostics.push_back({"pulse", "is given with model: cerqueira2017; it belongs to physical"});
        if (config.pulse->chirp_us && !(config.motion_in_ping && config.frequency_khz))
            diagnostics.push_back(
                {"pulse.chirp_us", "is given without motion_in_ping: true and frequency_khz, both of which it needs"});
    }
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        constexpr const char* name = "range point-spread";
        if (!plan.config.pulse) return leaveOut(plan, {name, Reason::NotConfigured});
        const acoustics::Pulse pulse(*plan.config.pulse, plan.grid.speed_of_sound);
        if (isShort(pulse, plan.grid))
            return leaveOut(plan, {name, Reason::BelowBound, pulse.resolution(), plan.grid.bin_width / 2, lengthWords});
        plan.add(Pass::Pulse);
        return true;
    }
    std::string takeOut(SonarConfig& config) const override { return takenOut(config.pulse, "pulse"); }
};

}  // namespace

const Effect& pulse() { return only<PulseInRange>(); }

}  // namespace insonify::sonar
