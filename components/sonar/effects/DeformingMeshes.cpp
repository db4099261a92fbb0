#include <algorithm>

#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

std::string withoutDeforming(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "no mesh has a skin or morph targets";
}

/** Meshes that skins and morph targets deform from ping to ping. EchoRenderer::takeShapes() poses them. */
class DeformingMeshes final : public Effect {
public:
    bool plan(const types::Geometry& geometry, RenderPlan& plan) const override {
        if (std::ranges::any_of(geometry.meshes, [](const auto& mesh) { return mesh.deformation != nullptr; }))
            return true;
        return leaveOut(plan, {.effect = "deforming meshes", .reason = Reason::NoneInScene, .words = withoutDeforming});
    }
};

}  // namespace

const Effect& deformingMeshes() { return only<DeformingMeshes>(); }

}  // namespace insonify::sonar
