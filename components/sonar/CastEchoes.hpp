#pragma once
#include <memory>

#include "components/sonar/EchoRenderer.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** Whether this build has rays. */
bool haveRays();

/** Pings by rays on the processor, without OpenGL. Beams are shared out to the threads as these come free; a beam's
 *  rays are cast, deposited and turned into bins by one thread, while they are in its cache. Throws std::runtime_error
 *  where the build has none, or Embree refuses the scene. */
std::unique_ptr<EchoRenderer> makeCastEchoes(const RenderPlan& plan, types::GeometryPtr geometry);

}  // namespace insonify::sonar
