#pragma once
#include <string>
#include <vector>

#include "components/gpu/Program.hpp"
#include "components/sonar/Culler.hpp"
#include "components/sonar/SurfaceScene.hpp"

namespace insonify::sonar {

/** Draws what one slab sees: for each pixel its triangle, and with normal maps the mapped cosine (surface.frag.glsl). */
class SurfacePass {
public:
    SurfacePass(const types::Geometry& geometry, const std::vector<Slab>& slabs, const std::vector<std::string>& defines,
                double near_plane, size_t run_limit);

    /** Where all objects are; once a ping. */
    void place(const std::vector<ObjectRecord>& records);
    /** Draws the runs into `picture()`; everything else in it is a miss. */
    void draw(const Slab& slab, const std::vector<Culler::Run>& runs);
    /** Binds picture (unit 0), objects, commands, planes and materials, for a compute shader. */
    void bindResults() const;
    /** Reads the picture: channels() words a pixel, row by row from below. */
    void read(std::vector<uint32_t>& words) const;
    int channels() const { return with_normal_maps_ ? 4 : 2; }

    // What the picture's numbers mean, as last drawn.
    const std::vector<CommandRecord>& commands() const { return record_list_; }
    const std::vector<ObjectRecord>& objects() const { return *placed_; }
    const SurfaceScene& scene() const { return scene_; }

private:
    struct DrawCommand { uint32_t count, instances, first_index, base_vertex, base_instance; };
    void setUniforms(const Slab& slab) const;
    void upload(const std::vector<Culler::Run>& runs);
    void drawGroups() const;

    const types::Geometry& geometry_;
    bool with_normal_maps_;
    SurfaceScene scene_;
    gpu::Program program_;
    gpu::Texture picture_, depth_;
    gpu::Framebuffer target_;
    gpu::Buffer objects_, records_, commands_;
    double near_plane_;
    const std::vector<ObjectRecord>* placed_ = nullptr;
    std::vector<CommandRecord> record_list_;
    std::vector<DrawCommand> command_list_;
};

}  // namespace insonify::sonar
