#pragma once
#include <string>
#include <vector>

#include "components/gpu/Program.hpp"
#include "components/sonar/Culler.hpp"
#include "components/sonar/SurfaceScene.hpp"

namespace insonify::sonar {

/** Draws what one slab sees: for each pixel the slant range, its slope and the echo strength (surface.frag.glsl). */
class SurfacePass {
public:
    SurfacePass(const types::Geometry& geometry, const std::vector<Slab>& slabs, const std::vector<std::string>& defines,
                double near_plane, size_t run_limit);

    /** Where all objects are; once a ping. */
    void place(const std::vector<ObjectRecord>& records);
    /** Draws the runs into `picture()`; everything else in it is a miss. */
    void draw(const Slab& slab, const std::vector<Culler::Run>& runs);
    const gpu::Texture& picture() const { return picture_; }

private:
    struct DrawCommand { uint32_t count, instances, first_index, base_vertex, base_instance; };
    void setUniforms(const Slab& slab) const;
    void upload(const std::vector<Culler::Run>& runs);
    void drawGroups() const;

    const types::Geometry& geometry_;
    SurfaceScene scene_;
    gpu::Program program_;
    gpu::Texture picture_, depth_;
    gpu::Framebuffer target_;
    gpu::Buffer objects_, records_, commands_;
    bool with_normal_maps_;
    double near_plane_;
    std::vector<CommandRecord> record_list_;
    std::vector<DrawCommand> command_list_;
};

}  // namespace insonify::sonar
