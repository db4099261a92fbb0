#pragma once
#include <memory>
#include <span>
#include <vector>

#include "components/gpu/Objects.hpp"
#include "components/sonar/raster/Culler.hpp"
#include "components/sonar/raster/SurfaceScene.hpp"

namespace insonify::gpu {
class EglContext;
}

namespace insonify::sonar {

/** Rows of the matrix from object axes to the image: u and v times depth over their extents, depth along the axis. */
struct Clip {
    vec4 x, y, w;
};
Clip computeClip(const ObjectRecord& object, const ViewFrustum& frustum);

/** Transform for a normal map, for normals and for tangents: rows of the matrices from object axes to the frustum's (x
 *  into the picture, y to port, z up). The first row's w is the scale of the map. */
struct NormalTransform {
    vec4 normal[3], tangent[3];
};
NormalTransform normalTransform(const ObjectRecord& object, const ViewFrustum& frustum, float normal_scale);

/** One indirect draw, in OpenGL's layout. */
struct DrawCommand {
    uint32_t count, instances, first_index, base_vertex, base_instance;
};

/** Consecutive draws with the same normal map. */
struct DrawGroup {
    size_t first, last;
    int normal_map;
};

/** The draws of a frustum. */
struct Draws {
    const gpu::Buffer *clips, *normal_transforms, *commands, *indirect;  ///< On the device, one entry per draw.
    std::span<const DrawGroup> groups;
    std::span<const DrawCommand> known;  ///< `indirect` on the processor; empty where only the device has it.
};

/** The parts of a scene that were rasterised in a ping. */
struct Shown {
    std::vector<bool> objects;
    size_t triangles = 0;  ///< A triangle in two frusta counts twice.
    size_t empty_frusta = 0;
};

/** The draws of each frustum in a ping. */
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

    /** Uploads the culler's places of the objects. */
    void place();
    const gpu::Buffer& objects() const { return objects_.buffer(); }

    /** Lists the placed parts that a frustum may see. Several threads may list different frusta. */
    virtual void list(size_t frustum, const ViewFrustum& view) = 0;
    /** Returns whether there may be anything to rasterise. */
    virtual bool mayShow(size_t frustum) const = 0;
    /** Switches to the present boxes of the clusters of an object's mesh. */
    virtual void updateShape(uint32_t /*object*/) {}
    /** Queues the device's work that precedes the rasterising of all frusta. */
    virtual void prepare(std::span<const ViewFrustum>) {}
    /** Returns the max draws of a frustum. */
    size_t drawLimit() const { return setup_.culler.drawRangeLimit(); }
    virtual Draws draws(size_t frustum) const = 0;
    /** Returns the commands of a frustum's draws. */
    virtual std::span<const CommandRecord> commands(size_t frustum) const = 0;
    /** Returns whether nothing was rasterised. Valid once all frusta are rasterised, until the next ping is listed. */
    virtual bool empty() const = 0;
    virtual Shown shown() const = 0;

protected:
    Setup setup_;

private:
    gpu::UploadList<ObjectRecord> objects_;
};

/** Makes lists on the processor. */
std::unique_ptr<DrawLists> makeProcessorLists(const DrawLists::Setup& setup);
/** Makes lists whose clusters are culled by a compute shader: the same triangles. The context outlives them. */
std::unique_ptr<DrawLists> makeDeviceLists(const DrawLists::Setup& setup, gpu::EglContext& context);

}  // namespace insonify::sonar
