#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"
#include "types/geometry/Geometry.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::sonar {

class Accumulator;
class DeformedMeshes;
class PingEffects;
class RayPaths;

/** Time that a ping spent in one stage [s]. */
struct Stage {
    const char* name;
    double seconds;
};
using Stages = std::array<Stage, 5>;
inline constexpr Stages empty_stages{{{"cull", 0}, {"draw", 0}, {"read", 0}, {"deposit", 0}, {"beams", 0}}};
enum StageOf { CullStage, DrawStage, ReadStage, DepositStage, BeamStage };

/** Fills the bins of pings by a plan, rasterised by OpenGL or ray-traced on the processor. Plan and effects outlive it.
 */
class EchoRenderer {
public:
    virtual ~EchoRenderer() = default;
    /** Switches to the plan's current quality. Allocates memory. */
    virtual void updateQuality() = 0;
    /** Switches to another geometry and keeps what has not changed. Returns false where another renderer is needed.
     *  Without `same_plan` the plan may have other laws, features and passes. */
    virtual bool setScene(types::GeometryPtr /*geometry*/, bool /*same_plan*/) { return false; }
    /** Switches to the plan, which is of another configuration now, and keeps what depends on the scene alone. Returns
     *  false where another renderer is needed. */
    virtual bool changePlan() { return false; }
    /** Switches to the geometry of `meshes`, whose objects deform, and takes their shapes in each ping from then on;
     *  null: to `geometry`, in which no object deforms. A rasterising renderer must have that geometry already. */
    virtual void deform(DeformedMeshes* meshes, types::GeometryPtr geometry) = 0;
    /** Poses the meshes by a snapshot, before any part of a ping reads them. */
    virtual void updateShapes(const types::Snapshot& snapshot) = 0;
    /** Forgets all pings, as if the renderer and the effects had just been made. Returns false where a new renderer is
     *  needed. */
    virtual bool forget() { return false; }
    /** Does only the part of a ping on which later pings depend, after updateShapes(). */
    virtual void follow(const types::Snapshot& /*snapshot*/) {}
    /** Fills ping.bins, which have their size; adds to `stages`. Allocates nothing after the first ping. */
    virtual void render(const types::Snapshot& snapshot, types::Sonar& ping, Stages& stages) = 0;
    /** Sets the truth that the next pings fill; its grid is theirs already. Null: no truth is recorded. */
    virtual void setTruth(types::SonarTruth* truth) = 0;
    /** Returns what has summed the last ping's echoes, before detect(). */
    virtual Accumulator& accumulator() = 0;
    /** Returns the bent sound paths of the last ping; null where all paths are straight. */
    virtual const RayPaths* bent() const { return nullptr; }
    /** Returns whether the last ping has any echo. */
    virtual bool hasEchoes() const = 0;
    /** Returns the parts of the scene that the last ping omitted. */
    virtual std::vector<Omitted> culled() const { return {}; }
    /** Returns the device: an OpenGL renderer and its driver, or the processor. */
    virtual const std::string& device() const = 0;
    /** Adds a notice about the device for the user. */
    virtual void note(types::Notices& /*notices*/) const {}
};

/** Makes a renderer that traces rays on the processor, without OpenGL. Threads take beams as they become free. One
 *  thread traces a beam's rays, deposits them and fills its bins, while they are in its cache. Throws
 *  std::runtime_error where Embree refuses the scene. */
std::unique_ptr<EchoRenderer> makeRayEchoes(const RenderPlan& plan, types::GeometryPtr geometry, PingEffects& effects);

/** Makes a renderer that rasterises pings by OpenGL. Make it, use it and destroy it on one thread, under
 *  EglContext::making(). Throws gpu::GlError when there is no OpenGL 4.5 context, or when it is lost. */
std::unique_ptr<EchoRenderer> makeRasterEchoes(const RenderPlan& plan, types::GeometryPtr geometry,
                                               const PingEffects& effects);

}  // namespace insonify::sonar
