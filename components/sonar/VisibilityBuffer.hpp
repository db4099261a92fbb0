#pragma once
#include <memory>
#include <vector>

#include "components/gpu/Objects.hpp"
#include "components/gpu/Program.hpp"
#include "components/sonar/Culler.hpp"

namespace insonify::sonar {

/** What one frustum sees: for each pixel its triangle, and with normal maps the mapped cosine (surface.frag.glsl).
 *  Make, draw and destroy it in one context; other contexts of the same device may read it once it is finished. */
class VisibilityBuffer {
public:
    /** One indirect draw, as OpenGL lays it out. */
    struct DrawCommand {
        uint32_t count, instances, first_index, base_vertex, base_instance;
    };

    /** Rows of the matrix from object axes to the image: u and v times depth over their extents, depth along the axis.
     */
    struct Clip {
        vec4 x, y, w;
    };

    /** What a normal map needs: rows of the matrices from object axes to the frustum's (x into the picture, y to port,
     * z up) for normals, the first row's w the scale of the map, and for tangents. */
    struct NormalTransform {
        vec4 normal[3], tangent[3];
    };

    /** At most `run_limit` runs are drawn. `context` is current and outlives the picture. */
    VisibilityBuffer(const ViewFrustum& frustum, bool with_normal_maps, size_t draw_range_limit,
                     gpu::EglContext& context);
    ~VisibilityBuffer();

    const ViewFrustum& frustum() const { return frustum_; }
    bool empty() const { return ranges.empty(); }
    int channels() const { return channels_; }
    /** The picture: channels() words a pixel, row by row from below; `words` has its size already. */
    void read(std::vector<uint32_t>& words) const;
    void bindTexture(GLuint unit) const { ids_.bind(unit); }
    /** Makes the picture the target and all of it a miss. */
    void clear() const;
    /** Ends the drawing: several samples a pixel become pixels. */
    void resolve() const;
    /** Tells the device `clips`, `bends` and, where they are drawn from there, `draws`. */
    void upload(bool with_draws);
    const gpu::Buffer& deviceDraws() const { return device_draws_; }
    const gpu::Buffer& deviceClips() const { return device_clips_; }
    const gpu::Buffer& deviceNormalTransforms() const { return device_normal_transforms_; }

    std::vector<Culler::DrawRange> ranges;           ///< What there is to draw.
    std::vector<CommandRecord> commands;             ///< One for each run.
    std::vector<Clip> clips;                         ///< One for each run.
    std::vector<NormalTransform> normal_transforms;  ///< One for each run; none without normal maps.
    std::vector<DrawCommand> draws;                  ///< One for each run.

private:
    ViewFrustum frustum_;
    int channels_;
    gpu::Texture ids_, depth_;
    gpu::Framebuffer target_;
    struct Multisampled;
    std::unique_ptr<Multisampled> multisampled_;  ///< What is drawn into when a pixel has several samples.
    gpu::Buffer device_clips_, device_normal_transforms_, device_draws_;
};

}  // namespace insonify::sonar
