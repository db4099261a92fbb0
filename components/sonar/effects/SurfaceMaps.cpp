#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

std::string withoutMaps(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "no material has one"; }
std::string byReflectivity(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "cerqueira2017 uses the reflectivity of the material only";
}
std::string mapsNeedRays(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "the scene is rasterised; surface maps need `visibility: cpu`";
}

/** Strengths and materials from maps on surfaces (ACOUSTICS.md 3.13). RayEchoes looks them up. */
class SurfaceMaps final : public Effect {
public:
    bool plan(const types::Geometry& geometry, RenderPlan& plan) const override {
        double maximum = 0;
        for (const types::Material& material : geometry.materials)
            maximum = std::max(maximum, static_cast<double>(material.max_map_strength));
        const auto omit = [&](Reason reason, Omitted::Words words) {
            return leaveOut(plan, {.effect = "surface maps", .reason = reason, .words = words});
        };
        if (!(maximum > 0)) return omit(Reason::NoneInScene, withoutMaps);
        if (plan.config.model != Model::Physical) return omit(Reason::Other, byReflectivity);
        if (!plan.traces_rays) return omit(Reason::Lacking, mapsNeedRays);
        plan.add(Pass::SurfaceMaps);
        plan.max_map_strength = std::max(maximum, 1.0);
        return true;
    }
};

}  // namespace

const Effect& surfaceMaps() { return only<SurfaceMaps>(); }

}  // namespace insonify::sonar
