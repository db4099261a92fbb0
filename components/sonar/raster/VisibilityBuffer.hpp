#pragma once
#include <memory>

#include "components/gpu/Objects.hpp"
#include "components/gpu/Program.hpp"
#include "components/gpu/ReadBack.hpp"
#include "components/sonar/beams/BeamFan.hpp"

namespace insonify::sonar {

/** The picture of one frustum: for each pixel its triangle, and with normal maps the mapped cosine (surface.frag.glsl).
 *  Make, rasterise and destroy it in one context; other contexts of the same device may read it once it is finished. */
class VisibilityBuffer {
public:
    /** `context` is current and outlives the picture. */
    VisibilityBuffer(const ViewFrustum& frustum, bool with_normal_maps, gpu::EglContext& context);
    ~VisibilityBuffer();

    const ViewFrustum& frustum() const { return frustum_; }
    int channels() const { return channels_; }
    /** Returns the number of bytes that `read` transfers. */
    size_t bytes() const;
    /** Requests the picture: channels() words of 32 bits per pixel, row by row from below. */
    void read(gpu::ReadBack& words) const;
    void bindTexture(GLuint unit) const { ids_.bind(unit); }
    /** Makes the picture the render target and sets all pixels to miss. */
    void clear() const;
    /** Finishes rasterising: resolves several samples per pixel into pixels. */
    void resolve() const;

private:
    ViewFrustum frustum_;
    int channels_;
    gpu::Texture ids_, depth_;
    gpu::Framebuffer target_;
    struct Multisampled;
    std::unique_ptr<Multisampled> multisampled_;  ///< Render target when a pixel has several samples.
};

}  // namespace insonify::sonar
