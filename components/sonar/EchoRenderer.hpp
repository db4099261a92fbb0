#pragma once
#include <array>
#include <string>
#include <vector>

#include "components/sonar/RenderPlan.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

/** Where the time of a ping went: cull, draw, read, deposit, beams. */
struct Stage {
    const char* name;
    double seconds;
};
using Stages = std::array<Stage, 5>;
enum StageOf { CullStage, DrawStage, ReadStage, DepositStage, BeamStage };

/** Fills the bins of pings as a plan says, which outlives it. One interface: drawn by OpenGL, or cast as rays on the
 *  processor. */
class EchoRenderer {
public:
    virtual ~EchoRenderer() = default;
    /** Renders from now on with the quality that the plan has by now; allocates. */
    virtual void takeQuality() = 0;
    /** Fills ping.bins, which have their size; adds to `stages`. Allocates nothing after the first ping. */
    virtual void render(const types::Snapshot& snapshot, types::Sonar& ping, Stages& stages) = 0;
    /** Whether the last ping has any echo. */
    virtual bool hasEchoes() const = 0;
    /** What of the scene the last ping left out. */
    virtual std::vector<LeftOut> culled() const = 0;
    /** What is compiled into what renders: what the plan wants, unless one of the two is wrong. */
    virtual Features compiled() const = 0;
    /** What renders: an OpenGL renderer and its driver, or the processor. */
    virtual const std::string& device() const = 0;
    /** What a user should know of the device; empty: nothing. */
    virtual std::string notice() const { return {}; }
};

}  // namespace insonify::sonar
