// In the place of CastEchoes.cpp where the build is without Embree.
#include <stdexcept>

#include "components/sonar/EchoRenderer.hpp"

namespace insonify::sonar {

bool haveRays() { return false; }

std::unique_ptr<EchoRenderer> makeCastEchoes(const RenderPlan&, types::GeometryPtr, const PingEffects&) {
    throw std::runtime_error("this build has no rays (Embree); visibility may be auto or gl");
}

}  // namespace insonify::sonar
