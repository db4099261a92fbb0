#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Geometry.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::sonar {

class EchoField;
class PingEffects;
class RayPaths;

/** Where the time of a ping went: cull, draw, read, deposit, beams. */
struct Stage {
    const char* name;
    double seconds;
};
using Stages = std::array<Stage, 5>;
enum StageOf { CullStage, DrawStage, ReadStage, DepositStage, BeamStage };

/** Fills the bins of pings as a plan says; that and the effects outlive it. One interface: drawn by OpenGL, or cast as
 * rays on the processor. */
class EchoRenderer {
public:
    virtual ~EchoRenderer() = default;
    /** Renders from now on with the quality that the plan has by now; allocates. */
    virtual void takeQuality() = 0;
    /** Renders another geometry from now on, and keeps what has not changed; false: it cannot, another renderer is to
     * be made. `same_plan`: the plan is as it was; else it may have other laws, features and passes. */
    virtual bool takeScene(types::GeometryPtr /*geometry*/, bool /*same_plan*/) { return false; }
    /** Fills ping.bins, which have their size; adds to `stages`. Allocates nothing after the first ping. */
    virtual void render(const types::Snapshot& snapshot, types::Sonar& ping, Stages& stages) = 0;
    /** Pings rendered from now on tell there what their bins show, in their own grid, which it has; null: none is told.
     */
    virtual void setTruth(types::SonarTruth* truth) = 0;
    /** The field of the last ping, whose squares are still to be its bins; null where energies are summed. */
    virtual EchoField* field() { return nullptr; }
    /** The ways of sound in the last ping; null where all are straight. */
    virtual const RayPaths* bent() const { return nullptr; }
    /** Whether the last ping has any echo. */
    virtual bool hasEchoes() const = 0;
    /** What of the scene the last ping left out. */
    virtual std::vector<LeftOut> culled() const = 0;
    /** What renders: an OpenGL renderer and its driver, or the processor. */
    virtual const std::string& device() const = 0;
    /** What a user should know of the device; empty: nothing. */
    virtual std::string notice() const { return {}; }
};

/** Whether this build has rays. */
bool haveRays();

/** Pings by rays on the processor, without OpenGL. Beams are shared out to the threads as these come free; a beam's
 *  rays are cast, deposited and turned into bins by one thread, while they are in its cache. Throws std::runtime_error
 *  where the build has none, or Embree refuses the scene. */
std::unique_ptr<EchoRenderer> makeCastEchoes(const RenderPlan& plan, types::GeometryPtr geometry,
                                             const PingEffects& effects);

/** Pings drawn by OpenGL. Make it, use it and destroy it on one thread, under
 *  EglContext::making(). Throws gpu::GlError when there is no OpenGL 4.5 context, or when it is lost. */
std::unique_ptr<EchoRenderer> makeDrawnEchoes(const RenderPlan& plan, types::GeometryPtr geometry,
                                              const PingEffects& effects);

}  // namespace insonify::sonar
