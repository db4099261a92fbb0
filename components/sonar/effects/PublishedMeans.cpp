#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

std::string means(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "cerqueira2017: bins are means of S(n.d)";
}
std::string scaledMeans(const Omitted& what, const BinGrid& grid) {
    return means(what, grid) + "; reflectivity scales n.d";
}
std::string oneBin(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "published: one bin per pixel"; }
std::string imageEdge(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "published: the image's edge, which is inside the aperture except straight ahead";
}
std::string oneBeam(const Omitted& /*what*/, const BinGrid& /*grid*/) {
    return "published: every column belongs to one beam";
}
std::string fromZero(const Omitted& /*what*/, const BinGrid& /*grid*/) { return "published: bins begin at range 0"; }

/** Model `cerqueira2017`: the effects that bins of means do not have, and with `published: true` the published
 *  simulator. */
class PublishedMeans final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (plan.config.model != Model::Cerqueira2017) return false;
        const auto omit = [&](const char* effect, Omitted::Words words) {
            plan.omitted.push_back({.effect = effect, .reason = Reason::Other, .words = words});
        };
        omit("spreading", means);
        omit("backscatter by material", scaledMeans);
        if (!plan.config.published) return true;
        plan.features.add(Feature::Published);
        omit("range footprints", oneBin);
        omit("elevation mask", imageEdge);
        omit("shared columns", oneBeam);
        omit("near blanking", fromZero);
        return true;
    }
};

}  // namespace

const Effect& publishedMeans() { return only<PublishedMeans>(); }

}  // namespace insonify::sonar
