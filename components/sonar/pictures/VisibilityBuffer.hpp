#pragma once
#include <memory>

#include "components/gpu/Objects.hpp"
#include "components/gpu/Program.hpp"
#include "components/gpu/ReadBack.hpp"
#include "components/sonar/fan/BeamFan.hpp"

namespace insonify::sonar {

/** What one frustum sees: for each pixel its triangle, and with normal maps the mapped cosine (surface.frag.glsl).
 *  Make, draw and destroy it in one context; other contexts of the same device may read it once it is finished. */
class VisibilityBuffer {
public:
    /** `context` is current and outlives the picture. */
    VisibilityBuffer(const ViewFrustum& frustum, bool with_normal_maps, gpu::EglContext& context);
    ~VisibilityBuffer();

    const ViewFrustum& frustum() const { return frustum_; }
    int channels() const { return channels_; }
    /** How much `read` gives. */
    size_t bytes() const;
    /** Asks for the picture: channels() words of 32 bits a pixel, row by row from below. */
    void read(gpu::ReadBack& words) const;
    void bindTexture(GLuint unit) const { ids_.bind(unit); }
    /** Makes the picture the target and all of it a miss. */
    void clear() const;
    /** Ends the drawing: several samples a pixel become pixels. */
    void resolve() const;

private:
    ViewFrustum frustum_;
    int channels_;
    gpu::Texture ids_, depth_;
    gpu::Framebuffer target_;
    struct Multisampled;
    std::unique_ptr<Multisampled> multisampled_;  ///< What is drawn into when a pixel has several samples.
};

}  // namespace insonify::sonar
