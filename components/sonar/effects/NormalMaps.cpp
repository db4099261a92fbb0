#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

std::string noMap(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "no material has one"; }

/** Normals from a texture of the material (ACOUSTICS.md 3.4). */
class NormalMaps final : public Effect {
public:
    bool plan(const types::Geometry& geometry, RenderPlan& plan) const override {
        if (std::ranges::none_of(geometry.materials, [](const auto& material) { return material.normal_map >= 0; }))
            return leaveOut(plan, {.effect = "normal maps", .reason = Reason::NoneInScene, .words = noMap});
        plan.features.add(Feature::NormalMap);
        return true;
    }
};

}  // namespace

const Effect& normalMaps() { return only<NormalMaps>(); }

}  // namespace insonify::sonar
