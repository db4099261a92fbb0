#include <fmt/format.h>

#include <algorithm>

#include "components/sonar/beams/Directivity.hpp"
#include "components/sonar/plan/Effect.hpp"
#include "types/geometry/Angle.hpp"

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

/** Checks a receiving array whose law can be evaluated. */
void checkAlive(const SonarConfig& config, types::Diagnostics& diagnostics) {
    const acoustics::BeamLaw& law = *config.beam_pattern->receive.azimuth;
    if (law.aperture_m ? !config.frequency_khz : !law.width_deg) return;
    const size_t count = receivingElements(config);
    checkPlaces("imperfections.dead_elements", config.imperfections->dead_elements, count, "elements", diagnostics);
    if (std::ranges::count(config.imperfections->elementFactors(count), 0.0) == static_cast<std::ptrdiff_t>(count))
        diagnostics.push_back({"imperfections", fmt::format("leaves none of {} elements alive", count)});
}

/** Checks the properties of the receiving array. */
void checkReceivingArray(const SonarConfig& config, types::Diagnostics& diagnostics) {
    const ImperfectionsConfig& own = *config.imperfections;
    if (!own.hasElementErrors() && !own.focus_m) return;
    const auto& law = config.beam_pattern ? config.beam_pattern->receive.azimuth : std::optional<acoustics::BeamLaw>();
    const char* const name = own.hasElementErrors() ? "imperfections" : "imperfections.focus_m";
    if (!law)
        return diagnostics.push_back({name, "needs beam_pattern.receive.azimuth, whose aperture the elements fill"});
    const acoustics::Weighting weighting = law->weighting.value_or(acoustics::Weighting::Uniform);
    if (!law->file.empty())
        return diagnostics.push_back(
            {name, "is given with a measured table in beam_pattern.receive.azimuth, which has its device's errors"});
    if (weighting == acoustics::Weighting::Gaussian || weighting == acoustics::Weighting::Piston)
        return diagnostics.push_back(
            {name,
             "needs a weighted line in beam_pattern.receive.azimuth; a gaussian or piston is no row of elements"});
    if (own.focus_m && !config.frequency_khz)
        diagnostics.push_back({"imperfections.focus_m", "is given without frequency_khz, which it needs"});
    if (own.focus_m && config.elements)
        diagnostics.push_back(
            {"imperfections.focus_m",
             "is given with elements, whose signals are those of the far field; give one of the two"});
    if (own.elements && config.elements)
        diagnostics.push_back({"imperfections.elements", "is given with elements; their number is that of `elements`"});
    if (diagnostics.empty() && own.hasElementErrors()) checkAlive(config, diagnostics);
}

/** Directivity (ACOUSTICS.md 5.9): in elevation when cells are summed, in azimuth when beams are formed of them. */
class BeamPatterns final : public Effect {
public:
    void check(const SonarConfig& config, types::Diagnostics& diagnostics) const override {
        if (config.imperfections) checkReceivingArray(config, diagnostics);
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
    void note(const RenderPlan& plan, const types::Geometry& /*geometry*/, types::Notices& notices) const override {
        if (plan.directivity && plan.directivity->hasBoxes())
            notices.push_back(
                fmt::format("the receiver has no law in azimuth: each beam receives its own {:.4g} deg alike, times "
                            "the transmit law",
                            types::degrees(plan.directivity->boxWidth())));
    }
    std::string removeFrom(SonarConfig& config) const override {
        return removeBlock(config.beam_pattern, "beam pattern");
    }
};

}  // namespace

const Effect& beamPatterns() { return only<BeamPatterns>(); }

}  // namespace insonify::sonar
