#pragma once
#include <memory>

#include "components/sonar/EchoRenderer.hpp"
#include "types/Geometry.hpp"

namespace insonify::sonar {

/** How the device is used, where no user has a choice: whatever is chosen, the bins are the same bit for bit. */
struct DrawOptions {
    enum class CullOn { Auto, Processor, Device };
    enum class SumIn { Auto, Memory, Groups };
    size_t ring = 0;                ///< Pings that may be under way; 0: three on a graphics card, else one.
    CullOn cull_on = CullOn::Auto;  ///< Who culls clusters; auto: a graphics card that deposits as well.
    SumIn sum_in = SumIn::Auto;     ///< Where a device's deposit sums first; auto: in work groups on a graphics card.
};

/** Pings drawn by OpenGL. Make it, use it and destroy it on one thread, under
 *  EglContext::making(). Throws gpu::GlError when there is no OpenGL 4.5 context, or when it is lost. */
std::unique_ptr<PipelinedEchoes> makeDrawnEchoes(const RenderPlan& plan, types::GeometryPtr geometry,
                                                 const DrawOptions& options = {});

}  // namespace insonify::sonar
