#pragma once
#include <string>

#include "components/gpu/Limits.hpp"
#include "components/sonar/pictures/BinDeposit.hpp"
#include "components/sonar/plan/RenderPlan.hpp"

namespace insonify::sonar {

/** Limits of OpenGL that the pictures of a plan need. */
gpu::Limits drawingNeeds(const RenderPlan& plan, const types::Geometry& geometry);

/** Limits of OpenGL that summing the pictures on the device, and culling clusters there, need. */
gpu::Limits depositNeeds(const DepositSetup& setup, const types::Geometry& geometry);

/** Throws GlError with the first limit that is too low to draw. `renderer` is the GL_RENDERER that has the limits. */
void requireDrawing(const gpu::Limits& limits, const gpu::Limits& needs, const std::string& renderer);

/** Why pictures that the device was to sum are summed on the processor, a sentence. Empty: the device sums them. Throws
 *  GlError where `deposit: gpu` asks for a device that cannot. */
std::string whyOnProcessor(Deposit deposit, const gpu::Limits& limits, const gpu::Limits& needs,
                           const std::string& renderer);

}  // namespace insonify::sonar
