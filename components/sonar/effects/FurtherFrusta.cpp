#include <fmt/format.h>

#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

std::string oneImage(const Omitted& what, const BinGrid& /*grid*/) {
    return fmt::format("one image shows all {:g} deg", what.value);
}

/** Several images of a fan that is too wide for one. */
class Frusta final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (plan.frusta.size() != 1) return !plan.frusta.empty();
        return leaveOut(plan, {.effect = "further slabs",
                               .reason = Reason::Other,
                               .value = plan.config.coverageDeg(),
                               .words = oneImage});
    }
};

}  // namespace

const Effect& furtherFrusta() { return only<Frusta>(); }

}  // namespace insonify::sonar
