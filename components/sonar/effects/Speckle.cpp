#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

/** Echoes that interfere (ACOUSTICS.md 5.21): sums of cells are fields of scatterers. */
class Speckle final : public Effect {
public:
    void check(const SonarConfig& config, types::Diagnostics& diagnostics) const override {
        if (config.speckle && !config.speckle->coherent && config.speckle->scatterers_per_m2)
            diagnostics.push_back({"speckle.scatterers_per_m2", "is given without coherent: true, which it needs"});
        if (config.isCoherent() && !config.frequency_khz)
            diagnostics.push_back({"speckle", "is coherent without frequency_khz, which it needs"});
    }
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (!plan.config.isCoherent()) return leaveOut(plan, {"coherent speckle", Reason::NotConfigured});
        plan.features.add(Feature::Speckle);
        return true;
    }
};

}  // namespace

const Effect& speckle() { return only<Speckle>(); }

}  // namespace insonify::sonar
