#pragma once
#include <string>
#include <vector>

#include "components/gpu/Program.hpp"
#include "components/sonar/SurfaceScene.hpp"
#include "components/sonar/VisibilityBuffer.hpp"

namespace insonify::sonar {

/** Draws frusta in the context in which it was made. */
class SurfacePainter {
public:
    /** `defines` as the plan's features; nothing nearer than `near_plane` [m] along a frustum's axis is drawn.
     * `geometry`, `scene` and `context`, which is current, must outlive the painter; the scene may be another
     * context's. */
    SurfacePainter(const types::Geometry& geometry, const SurfaceScene& scene, const std::vector<std::string>& defines,
                   double near_plane, gpu::EglContext& context);

    /** Lists how the runs of a picture are drawn, of objects `placed` so; the device knows nothing of it yet. */
    void list(VisibilityBuffer& picture, const std::vector<ObjectRecord>& placed) const;
    /** Tells the device what is listed. */
    void upload(VisibilityBuffer& picture) const { picture.upload(!software_); }
    /** Draws what is listed and uploaded; everything else in the picture is a miss. */
    void draw(const VisibilityBuffer& picture) const;

private:
    void setUniforms(const ViewFrustum& frustum) const;
    void drawGroups(const VisibilityBuffer& picture) const;
    void drawRuns(const VisibilityBuffer& picture, size_t first, size_t last) const;

    const types::Geometry& geometry_;
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
