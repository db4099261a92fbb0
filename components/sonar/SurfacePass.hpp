#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/sonar/SurfacePainter.hpp"
#include "components/sonar/ThreadPool.hpp"

namespace insonify::sonar {

/** Draws what all frusta see. On a graphics card one context does it; Mesa's software renderer prepares triangles on
 * the calling thread alone, so there each thread of the pool has a context and a share of the frusta. */
class SurfacePass {
public:
    struct Setup {
        const types::Geometry& geometry;
        std::vector<ViewFrustum> frusta;
        std::vector<std::string> defines;  ///< As the plan's features.
        double near_plane;                 ///< [m]
        size_t draw_range_limit;           ///< Most runs that a frustum may see.
        bool empty_too;                    ///< Frusta that see nothing are drawn as well: misses count.
    };
    /** `context` is current on this thread; context, geometry and threads must outlive the pass. */
    SurfacePass(gpu::EglContext& context, Setup setup, ThreadPool& threads);
    ~SurfacePass();

    /** Other pictures of the same frusta: as many, in more or fewer pixels. */
    void resize(const std::vector<ViewFrustum>& frusta);

    /** Lists what each frustum sees of what the culler has placed. */
    void cull(const Culler& culler);
    /** Whether a frustum's picture is drawn. */
    bool draws(size_t frustum) const { return setup_.empty_too || !pictures_[frustum]->empty(); }
    /** Draws the frusta. A graphics card may still be at it when this returns; what its context is asked for then comes
     *  after. Throws GlError. All other functions but objects() and draws() want EglContext::transferring(); this one
     *  does that itself. */
    void draw();

    const VisibilityBuffer& picture(size_t frustum) const { return *pictures_[frustum]; }
    const SurfaceScene& scene() const { return scene_; }
    const std::vector<ObjectRecord>& objects() const { return *placed_; }
    /** Binds a picture (unit 0), planes and materials, for a compute shader. */
    void bindResults(size_t frustum) const;

private:
    /** One thread's part; made, used and destroyed there. */
    struct Part {
        std::optional<gpu::EglContext> own;  ///< Of all threads but the first, which has the renderer's.
        std::optional<SurfacePainter> painter;
    };
    gpu::EglContext& contextOf(size_t part) { return parts_[part].own ? *parts_[part].own : context_; }
    void release();
    void makePart(size_t part);
    void makePictures(size_t part);
    template <class Job>
    void onEachPart(const Job& job);
    template <class Use>
    void onDrawn(size_t part, const Use& use);

    Setup setup_;
    gpu::EglContext& context_;
    ThreadPool& threads_;
    SurfaceScene scene_;
    std::vector<Part> parts_;
    std::vector<std::unique_ptr<VisibilityBuffer>> pictures_;
    const std::vector<ObjectRecord>* placed_ = nullptr;
};

}  // namespace insonify::sonar
