#pragma once
#include <string>
#include <vector>

#include "components/gpu/Program.hpp"
#include "components/sonar/DrawLists.hpp"
#include "components/sonar/VisibilityBuffer.hpp"

namespace insonify::sonar {

/** Draws frusta in the context in which it was made. */
class SurfacePainter {
public:
    /** `defines` as the plan's features; nothing nearer than `near_plane` [m] along a frustum's axis is drawn.
     *  `scene` and `context`, which is current, must outlive the painter; the scene may be another context's. */
    SurfacePainter(const SurfaceScene& scene, const std::vector<std::string>& defines, double near_plane,
                   gpu::EglContext& context);

    /** Draws what is listed; everything else in the picture is a miss. */
    void draw(const VisibilityBuffer& picture, const Draws& draws) const;

private:
    void setUniforms(const ViewFrustum& frustum) const;
    void drawGroup(const Draws& draws, const DrawGroup& group) const;

    const SurfaceScene& scene_;
    double near_plane_;
    bool software_;
    const gpu::Program& program_;
    gpu::VertexArray vertices_;
    struct Uniforms {
        GLint extent, pixel_size, near_plane, mapped;
    } uniforms_;
};

}  // namespace insonify::sonar
