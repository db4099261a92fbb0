#pragma once
#include <string>
#include <vector>

#include "components/gpu/Program.hpp"
#include "components/sonar/SlabPicture.hpp"
#include "components/sonar/SurfaceScene.hpp"

namespace insonify::sonar {

/** Draws slabs in the context in which it was made. */
class SurfacePainter {
public:
    /** `defines` as the plan's features; nothing nearer than `near_plane` [m] along a slab's axis is drawn. `geometry`
     *  and `scene` must outlive the painter; the scene may have been made in another context of the device. */
    SurfacePainter(const types::Geometry& geometry, const SurfaceScene& scene, const std::vector<std::string>& defines,
                   double near_plane);

    /** Where all objects are; once a ping. */
    void place(const std::vector<ObjectRecord>& records);
    /** Draws the runs of a picture, of objects `placed` so; everything else in it is a miss. */
    void draw(SlabPicture& picture, const std::vector<ObjectRecord>& placed) const;
    void bindObjects() const { objects_.bindBase(GL_SHADER_STORAGE_BUFFER, OBJECTS_BINDING); }

private:
    void listDraws(SlabPicture& picture, const std::vector<ObjectRecord>& placed) const;
    void setUniforms(const Slab& slab) const;
    void drawGroups(const SlabPicture& picture) const;

    const types::Geometry& geometry_;
    const SurfaceScene& scene_;
    double near_plane_;
    gpu::Program program_;
    gpu::VertexArray vertices_;
    gpu::Buffer objects_;
    struct Uniforms {
        GLint extent, pixel_size, near_plane, mapped;
    } uniforms_;
};

}  // namespace insonify::sonar
