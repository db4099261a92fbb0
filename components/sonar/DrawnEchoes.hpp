#pragma once
#include <memory>

#include "components/sonar/EchoRenderer.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** Pings drawn by OpenGL. Make it, use it and destroy it on one thread, under
 *  EglContext::making(). Throws gpu::GlError when there is no OpenGL 4.5 context, or when it is lost. */
std::unique_ptr<PipelinedEchoes> makeDrawnEchoes(const RenderPlan& plan, types::GeometryPtr geometry);

}  // namespace insonify::sonar
