#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/gpu/Objects.hpp"
#include "components/gpu/Program.hpp"
#include "components/sonar/base/ThreadPool.hpp"
#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/raster/DrawLists.hpp"

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

/** Rasterises frusta in the context in which it was made. */
class SurfacePainter {
public:
    /** `defines` as the plan's features. Nothing nearer than `near_plane` [m] along a frustum's axis is rasterised.
     *  `scene` and `context`, which is current, must outlive the painter; the scene may belong to another context. */
    SurfacePainter(const SurfaceScene& scene, const std::vector<std::string>& defines, double near_plane,
                   gpu::EglContext& context);

    /** Rasterises the listed draws; all other pixels of the picture are misses. */
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

/** Rasterises what all frusta see, ping after ping into the same pictures. On a graphics card it uses one context.
 *  Mesa's software renderer prepares triangles on the calling thread only, so there each thread of the pool has a
 *  context and a share of the frusta. */
class SurfacePass {
public:
    struct Setup {
        const types::Geometry& geometry;
        const MaterialLaws& laws;
        std::vector<ViewFrustum> frusta;
        std::vector<std::string> defines;  ///< As the plan's features.
        double near_plane;                 ///< [m]
        bool empty_too;                    ///< Frusta that see nothing are rasterised as well: misses count.
        bool cull_on_device = false;       ///< For clusters; objects are culled by the processor.
    };
    /** `context` is current on this thread; context, geometry, laws, culler and threads must outlive the pass. */
    SurfacePass(gpu::EglContext& context, Setup setup, Culler& culler, ThreadPool& threads);
    ~SurfacePass();

    /** Returns whether this pass serves another setup of the same scene, after updateLaws() and resize(). */
    bool serves(const Setup& other) const;
    /** Switches to the present laws of materials. */
    void updateLaws();
    /** Switches to pictures of as many frusta, with other numbers of pixels. */
    void resize(const std::vector<ViewFrustum>& frusta);

    /** Switches to the present shape of an object's mesh, before uploadShapes(). Several threads may take different
     *  objects. */
    void updateShape(uint32_t object);
    /** Uploads the shapes of these objects. */
    void uploadShapes(std::span<const uint32_t> objects);

    /** Lists the placed parts that each frustum sees. */
    void cull();
    /** Returns whether a frustum's picture is rasterised. */
    bool draws(size_t frustum) const { return setup_.empty_too || lists_->mayShow(frustum); }
    /** Rasterises the listed frusta. A graphics card may still be working when this returns; later requests to its
     *  context are executed after that. Throws GlError. All other functions except cull(), draws() and readers of the
     *  lists require EglContext::transferring(); this one enters it itself. */
    void draw();

    const VisibilityBuffer& picture(size_t frustum) const { return *pictures_[frustum]; }
    const SurfaceScene& scene() const { return scene_; }
    const DrawLists& lists() const { return *lists_; }
    /** Returns the culler's places of the objects. */
    const std::vector<ObjectRecord>& objects() const { return culler_.records(); }
    /** Binds a picture (unit 0), its commands, objects, planes and materials, for a compute shader. */
    void bindResults(size_t frustum) const;

private:
    /** One thread's part; made, used and destroyed there. */
    struct Part {
        std::optional<gpu::EglContext> own;  ///< Context of a thread; the first thread uses the renderer's.
        std::optional<SurfacePainter> painter;
    };
    gpu::EglContext& getContext(size_t part) { return parts_[part].own ? *parts_[part].own : context_; }
    void release();
    void makePart(size_t part);
    void makePictures(size_t part);
    void onEachPart(const auto& job);
    void drawPart(size_t part);

    Setup setup_;
    gpu::EglContext& context_;
    Culler& culler_;
    ThreadPool& threads_;
    SurfaceScene scene_;
    std::unique_ptr<DrawLists> lists_;
    std::vector<Part> parts_;
    std::vector<std::unique_ptr<VisibilityBuffer>> pictures_;
};

}  // namespace insonify::sonar
