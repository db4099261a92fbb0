// Replaces RayEchoes.cpp, PathEchoes.cpp and ForeignEchoes.cpp in a build without Embree.
#include <stdexcept>

#include "components/sonar/EchoRenderer.hpp"
#include "components/sonar/ways/ForeignEchoes.hpp"
#include "components/sonar/ways/PathEchoes.hpp"

namespace insonify::sonar {

bool haveRays() { return false; }

std::unique_ptr<EchoRenderer> makeRayEchoes(const RenderPlan&, types::GeometryPtr, PingEffects&) {
    throw std::runtime_error("this build has no rays (Embree); visibility may be auto or gl");
}

std::unique_ptr<PingEffect> makePathEchoes(const RenderPlan&, const types::Geometry&) { return nullptr; }

std::unique_ptr<ForeignEchoes> makeForeignEchoes(const RenderPlan&) { return nullptr; }

}  // namespace insonify::sonar
