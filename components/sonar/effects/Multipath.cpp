#include "components/sonar/multipath/Mirrors.hpp"
#include "components/sonar/multipath/PathCells.hpp"
#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

std::string noBounces(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "bounces is 0"; }
std::string noMirror(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no surface is configured, and no material is `mirror: true` or smooth enough";
}

/** Returns whether there are mirrors; `bounces` determines which materials reflect. */
bool hasMirrors(const MultipathConfig& multipath, const types::Geometry& geometry) {
    return multipath.surface || std::ranges::any_of(geometry.materials, [&](const types::Material& material) {
               return reflectedPower(material, multipath.bounces) > 0;
           });
}

/** Echoes via mirrors (ACOUSTICS.md 5.23), in ray-traced pings. */
class Multipath final : public Effect {
public:
    bool plan(const types::Geometry& geometry, RenderPlan& plan) const override {
        constexpr const char* name = "multipath";
        const std::optional<MultipathConfig>& multipath = plan.config.multipath;
        if (!multipath) return leaveOut(plan, {name, Reason::NotConfigured});
        if (!plan.config.tracesPaths())
            return leaveOut(plan, {.effect = name, .reason = Reason::Other, .words = noBounces});
        if (!hasMirrors(*multipath, geometry))
            return leaveOut(plan, {.effect = name, .reason = Reason::Other, .words = noMirror});
        plan.add(Pass::Paths);
        return true;
    }
    std::unique_ptr<PingEffect> make(const RenderPlan& plan, const types::Geometry& geometry) const override {
        return plan.traces_rays ? makePathEchoes(plan, geometry) : nullptr;
    }
    std::string removeFrom(SonarConfig& config) const override {
        if (!config.tracesPaths()) return {};
        config.multipath.reset();
        return "multipath";
    }
};

}  // namespace

const Effect& multipath() { return only<Multipath>(); }

}  // namespace insonify::sonar
