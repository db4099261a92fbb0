#include <algorithm>

#include "components/sonar/effects/Effect.hpp"

namespace insonify::sonar {
namespace {

std::string withoutDeforming(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no mesh has a skin or morph targets";
}
std::string deformingNeedsRays(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "rasterised scenes show skins and morph targets at rest; they deform with `visibility: cpu`";
}

/** Meshes that skins and morph targets deform from ping to ping. RayEchoes poses them. */
class DeformingMeshes final : public Effect {
public:
    bool plan(const types::Geometry& geometry, RenderPlan& plan) const override {
        const auto omit = [&](Reason reason, Omitted::Words words) {
            return leaveOut(plan, {.effect = "deforming meshes", .reason = reason, .words = words});
        };
        if (std::ranges::none_of(geometry.meshes, [](const auto& mesh) { return mesh.deformation != nullptr; }))
            return omit(Reason::NoneInScene, withoutDeforming);
        if (!plan.traces_rays) return omit(Reason::Lacking, deformingNeedsRays);
        return true;
    }
};

}  // namespace

const Effect& deformingMeshes() {
    static const DeformingMeshes effect;
    return effect;
}

}  // namespace insonify::sonar
