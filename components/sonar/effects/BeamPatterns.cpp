#include "components/sonar/effects/Effect.hpp"

namespace insonify::sonar {
namespace {

void checkLaws(const SonarConfig& config, types::Diagnostics& diagnostics) {
    const auto checkLaw = [&](const std::string& path, const std::optional<acoustics::BeamLaw>& law) {
        if (law && law->aperture_m)
            diagnostics.push_back(
                {"beam_pattern." + path + ".aperture_m", "is given without frequency_khz, which it needs"});
    };
    checkLaw("transmit.azimuth", config.beam_pattern->transmit.azimuth);
    checkLaw("transmit.elevation", config.beam_pattern->transmit.elevation);
    checkLaw("receive.azimuth", config.beam_pattern->receive.azimuth);
    checkLaw("receive.elevation", config.beam_pattern->receive.elevation);
}

/** Directivity (ACOUSTICS.md 5.9): in elevation as cells are summed, in azimuth as beams are formed of them. */
class BeamPatterns final : public Effect {
public:
    void check(const SonarConfig& config, types::Diagnostics& diagnostics) const override {
        if (!config.beam_pattern) return;
        if (config.model == Model::Cerqueira2017)
            diagnostics.push_back({"beam_pattern", "is given with model: cerqueira2017; it belongs to physical"});
        if (!config.frequency_khz) checkLaws(config, diagnostics);
    }
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        const bool azimuth = plan.directivity && plan.directivity->hasAzimuth();
        const bool elevation = plan.config.beam_pattern && plan.config.beam_pattern->hasElevation();
        if (azimuth)
            plan.add(Pass::Beamform);
        else
            leaveOut(plan, {"azimuth beam pattern", Reason::NotConfigured});
        if (elevation)
            plan.features.add(Feature::ElevationPattern);
        else
            leaveOut(plan, {"elevation beam pattern", Reason::NotConfigured});
        return azimuth || elevation;
    }
    std::string takeOut(SonarConfig& config) const override {
        if (!config.beam_pattern) return {};
        config.beam_pattern.reset();
        return "beam pattern";
    }
};

}  // namespace

const Effect& beamPatterns() {
    static const BeamPatterns effect;
    return effect;
}

}  // namespace insonify::sonar
