#pragma once
#include <memory>
#include <span>
#include <vector>

#include "components/gpu/Objects.hpp"
#include "components/sonar/pictures/Culler.hpp"
#include "components/sonar/pictures/SurfaceScene.hpp"

namespace insonify::gpu {
class EglContext;
}

namespace insonify::sonar {

/** Rows of the matrix from object axes to the image: u and v times depth over their extents, depth along the axis. */
struct Clip {
    vec4 x, y, w;
};
Clip clipOf(const ObjectRecord& object, const ViewFrustum& frustum);

/** What a normal map needs: rows of the matrices from object axes to the frustum's (x into the picture, y to port, z
 *  up) for normals, the first row's w the scale of the map, and for tangents. */
struct NormalTransform {
    vec4 normal[3], tangent[3];
};
NormalTransform normalTransformOf(const ObjectRecord& object, const ViewFrustum& frustum, float normal_scale);

/** One indirect draw, as OpenGL lays it out. */
struct DrawCommand {
    uint32_t count, instances, first_index, base_vertex, base_instance;
};

/** Draws that follow one another and have the same normal map. */
struct DrawGroup {
    size_t first, last;
    int normal_map;
};

/** What is drawn of a frustum. */
struct Draws {
    const gpu::Buffer *clips, *normal_transforms, *commands, *indirect;  ///< On the device, one of each for each draw.
    std::span<const DrawGroup> groups;
    std::span<const DrawCommand> known;  ///< `indirect` on the processor; empty where the device alone knows.
};

/** What of a scene was drawn in a ping. */
struct Shown {
    std::vector<bool> objects;
    size_t triangles = 0;  ///< Of two frusta twice.
    size_t empty_frusta = 0;
};

/** What is drawn of each frustum in a ping. */
class DrawLists {
public:
    struct Setup {
        const types::Geometry& geometry;
        const SurfaceScene& scene;
        Culler& culler;
        size_t frusta;
    };
    explicit DrawLists(const Setup& setup);
    virtual ~DrawLists() = default;

    /** Tells the device where the culler has placed the objects. */
    void place();
    const gpu::Buffer& objects() const { return objects_.buffer(); }

    /** Finds what a frustum may see of what is placed. Frusta may be listed side by side. */
    virtual void list(size_t frustum, const ViewFrustum& view) = 0;
    /** Whether there may be anything to draw. */
    virtual bool mayShow(size_t frustum) const = 0;
    /** Asks the device for what comes before the drawing of all frusta. */
    virtual void prepare(std::span<const ViewFrustum>) {}
    /** Most draws of a frustum that there can be. */
    size_t drawLimit() const { return setup_.culler.drawRangeLimit(); }
    virtual Draws draws(size_t frustum) const = 0;
    /** What the draws of a frustum are of. */
    virtual std::span<const CommandRecord> commands(size_t frustum) const = 0;
    /** Once all frusta are drawn, until the next ping is listed. */
    virtual bool empty() const = 0;
    virtual Shown shown() const = 0;

protected:
    Setup setup_;

private:
    gpu::UploadList<ObjectRecord> objects_;
};

/** Listed by the processor. */
std::unique_ptr<DrawLists> makeProcessorLists(const DrawLists::Setup& setup);
/** Clusters of the objects in view are culled by a compute shader: the same triangles. The context outlives it. */
std::unique_ptr<DrawLists> makeDeviceLists(const DrawLists::Setup& setup, gpu::EglContext& context);

}  // namespace insonify::sonar
