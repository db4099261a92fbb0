#include <fmt/format.h>

#include <numbers>

#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

constexpr const char* inside_a_bin = "absorption inside a bin";

/** Returns an absorption that changes by `residual` to either side of a bin's middle, in decibels. */
double decibels(double residual) { return 10 * residual / std::numbers::ln10; }

std::string residualWords(const Omitted& what, const BinGrid& /*grid*/) {
    if (what.reason == Reason::BelowBound) return fmt::format("beta dR/2 = {:.1e} < {:.0e}", what.value, what.bound);
    return fmt::format("beta dR/2 = {:.1e}, {:.2g} dB to either side", what.value, decibels(what.value));
}

/** Absorption of sound in the water (ACOUSTICS.md 2.4): evaluated in the middle of each bin, in `cerqueira2017` at each
 *  sample. */
class Absorption final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (!plan.config.absorption) return leaveOut(plan, {"absorption", Reason::NotConfigured});
        const acoustics::Absorption absorption = makeAbsorption(plan.config);
        if (plan.config.model == Model::Cerqueira2017) {
            if (absorption.db_per_m > 0) plan.features.add(Feature::Absorption);
            return true;
        }
        const double residual = absorption.intensityPerMetre() * plan.grid.bin_width / 2;
        const Reason reason = residual < 1e-3 ? Reason::BelowBound : Reason::Approximated;
        plan.omitted.push_back({inside_a_bin, reason, residual, 1e-3, residualWords});
        return true;
    }
    void note(const RenderPlan& plan, const types::Geometry& /*geometry*/,
              std::vector<std::string>& notices) const override {
        const Omitted* inside = plan.findOmitted(inside_a_bin);
        if (inside && decibels(inside->value) > 0.1)
            notices.push_back(
                fmt::format("Warning: absorption changes within a bin by {:.2g} dB to either side of its "
                            "middle; it is taken in the middle",
                            decibels(inside->value)));
    }
    void addTo(types::ReturnRules& rules, const SonarConfig& config) const override {
        rules.loss_db_per_m = makeAbsorption(config).db_per_m;
    }
    std::string takeOut(SonarConfig& config) const override { return takenOut(config.absorption, "absorption"); }
};

}  // namespace

const Effect& absorption() { return only<Absorption>(); }

}  // namespace insonify::sonar
