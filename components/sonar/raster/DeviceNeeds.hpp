#pragma once
#include <string>

#include "components/gpu/EglContext.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/raster/PictureDeposit.hpp"

namespace insonify::sonar {

/** Returns the limits of OpenGL that the pictures of a plan require. */
gpu::Limits drawingNeeds(const RenderPlan& plan, const types::Geometry& geometry);

/** Returns the limits of OpenGL that summing the pictures on the device, and culling clusters there, require. */
gpu::Limits depositNeeds(const DepositSetup& setup, const types::Geometry& geometry);

/** Throws GlError with the first limit that is too low to rasterise. `renderer` is the GL_RENDERER with the limits. */
void requireDrawing(const gpu::Limits& limits, const gpu::Limits& needs, const std::string& renderer);

/** Returns why pictures that the device was to sum are summed on the processor, as a sentence. Empty: the device sums
 *  them. Throws GlError where `deposit: gpu` requires a device that cannot. */
std::string whyOnProcessor(Deposit deposit, const gpu::Limits& limits, const gpu::Limits& needs,
                           const std::string& renderer);

}  // namespace insonify::sonar
