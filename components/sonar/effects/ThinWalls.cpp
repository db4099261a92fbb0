#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

std::string withoutShell(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "no material has a shell"; }
std::string withoutFrequency(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no frequency_khz; shells let nothing through";
}
std::string withoutRays(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "the scene is rasterised; sound passes through shells with `visibility: cpu`";
}
std::string onBentWays(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "sound passes through shells on straight paths only; remove water.profile and motion_in_ping";
}
std::string withoutWalls(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "max_walls is 0"; }

/** Sound that passes through thin walls (ACOUSTICS.md 5.26). RayEchoes traces it. */
class ThinWalls final : public Effect {
public:
    bool plan(const types::Geometry& geometry, RenderPlan& plan) const override {
        const bool has_shell =
            std::ranges::any_of(geometry.materials, [](const auto& one) { return one.shell.has_value(); });
        const auto omit = [&](Reason reason, Omitted::Words words) {
            return leaveOut(plan, {.effect = "thin walls", .reason = reason, .words = words});
        };
        if (!has_shell || plan.config.model != Model::Physical) return omit(Reason::NoneInScene, withoutShell);
        if (plan.config.max_walls == 0) return omit(Reason::Other, withoutWalls);
        if (!plan.config.frequency_khz) return omit(Reason::Lacking, withoutFrequency);
        if (!plan.traces_rays) return omit(Reason::Lacking, withoutRays);
        if (plan.profile || plan.config.motion_in_ping) return omit(Reason::Lacking, onBentWays);
        if (!plan.laws.hasWalls()) return omit(Reason::NoneInScene, withoutShell);
        plan.add(Pass::Walls);
        plan.laws.takeReturnsApart();
        return true;
    }
    std::string takeOut(SonarConfig& config) const override {
        if (config.max_walls == 0) return {};
        config.max_walls = 0;
        return "thin walls";
    }
};

}  // namespace

const Effect& thinWalls() { return only<ThinWalls>(); }

}  // namespace insonify::sonar
