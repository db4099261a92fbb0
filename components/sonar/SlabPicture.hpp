#pragma once
#include <memory>
#include <vector>

#include "components/gpu/Objects.hpp"
#include "components/gpu/Program.hpp"
#include "components/sonar/Culler.hpp"

namespace insonify::sonar {

/** What one slab sees: for each pixel its triangle, and with normal maps the mapped cosine (surface.frag.glsl).
 *  Make, draw and destroy it in one context; other contexts of the same device may read it once it is finished. */
class SlabPicture {
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

    /** What a normal map needs: rows of the matrices from object axes to the slab's (x into the picture, y to port, z
     * up) for normals, the first row's w the scale of the map, and for tangents. */
    struct Bend {
        vec4 normal[3], tangent[3];
    };

    /** At most `run_limit` runs are drawn. `context` is current and outlives the picture. */
    SlabPicture(const Slab& slab, bool with_normal_maps, size_t run_limit, gpu::EglContext& context);
    ~SlabPicture();

    const Slab& slab() const { return slab_; }
    bool empty() const { return runs.empty(); }
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
    const gpu::Buffer& deviceBends() const { return device_bends_; }

    std::vector<Culler::Run> runs;        ///< What there is to draw.
    std::vector<CommandRecord> commands;  ///< One for each run.
    std::vector<Clip> clips;              ///< One for each run.
    std::vector<Bend> bends;              ///< One for each run; none without normal maps.
    std::vector<DrawCommand> draws;       ///< One for each run.

private:
    Slab slab_;
    int channels_;
    gpu::Texture ids_, depth_;
    gpu::Framebuffer target_;
    struct Multisampled;
    std::unique_ptr<Multisampled> multisampled_;  ///< What is drawn into when a pixel has several samples.
    gpu::Buffer device_clips_, device_bends_, device_draws_;
};

}  // namespace insonify::sonar
