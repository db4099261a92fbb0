#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"
#include "components/sonar/plan/WaterView.hpp"
#include "types/Geometry.hpp"
#include "types/Snapshot.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

class EchoField;
class RayPaths;
struct EchoRules;
struct Cells;
struct Covered;

/** A batch of cells whose echoes are summed, and where an effect sums what is its own. */
struct CellBatch {
    const EchoRules& rules;
    const WaterView& water;
    const Cells& cells;
    const Covered& covered;
    int first_beam;      ///< Of the sums [1].
    uint64_t* own;       ///< Of the first beam: a number for each bin, in whole quanta; one more behind the last bin.
    size_t beam_stride;  ///< From one beam's numbers to the next one's [1].
};

/** A ping whose surfaces are heard. */
struct PingInMaking {
    const types::Snapshot& snapshot;
    types::Sonar& ping;    ///< Its bins hold intensities of the sorted beams, unless `field` is given.
    EchoField* field;      ///< What the bins will be the squares of; null where energies are summed.
    const RayPaths* bent;  ///< The ways of sound; null where they are straight.
};

/** What an effect is in the pings of one renderer: its numbers, and what it keeps from ping to ping. No call for a ping
 *  allocates after the first ones. */
class PingEffect {
public:
    virtual ~PingEffect() = default;

    /** Renders from now on with the quality that the plan has by now; may allocate. */
    virtual void takeQuality() {}
    /** Pings are of another scene from now on, with the same materials; the last one's goes. */
    virtual void takeScene(const types::Geometry& /*geometry*/) {}
    /** Once a ping, before all else. */
    virtual void begin(const types::Snapshot& /*snapshot*/) {}

    /** What it adds to the numbers that cells are summed by. */
    virtual void giveRules(EchoRules& /*rules*/) const {}
    /** Whether addCells() and addToCell() are called: a number for each bin of a beam is summed for it. */
    virtual bool hasSums() const { return false; }
    /** Whether the compute shader makes the same sums. One at most does; with others, pictures are summed on the
     *  processor, and where the device was to sum them a notice says so. */
    virtual bool isOnDevice() const { return false; }
    /** Of each batch of cells: adds to its sums. On several threads. */
    virtual void addCells(const CellBatch& /*batch*/) const {}
    /** Adds to the intensities of a cell's bins what its sums amount to. `unit`: the solid angle of a whole sample
     *  [sr]. On several threads. */
    virtual void addToCell(const uint64_t* /*sums*/, size_t /*cell*/, double /*unit*/,
                           std::span<float> /*bins*/) const {}

    /** Adds echoes to beams, before fields are squared. */
    virtual void addEchoes(PingInMaking& /*ping*/) {}
    /** Changes the bins of a ping, when all echoes are in them. */
    virtual void addToBins(types::Sonar& /*ping*/) {}

    /** Of how many things the last ping has an echo, beside surfaces [1]. */
    virtual size_t heard() const { return 0; }
    /** What the last ping left out of it; none before the first. */
    virtual std::optional<LeftOut> leftOut() const { return {}; }
};

/** An effect of a sonar's configuration or scene on its pings, in one file. The list of them (Effects.hpp) is the plan:
 *  what is compiled and run, and what is left out for which reason. */
class Effect {
public:
    virtual ~Effect() = default;

    /** The key of its numbers in SonarConfig::effects; empty: what it needs are fields of the configuration. */
    virtual std::string key() const { return {}; }
    /** Those numbers: name, unit, meaning and bounds of each. */
    virtual std::vector<types::Field> numbers() const { return {}; }
    /** What does not go together in a configuration. */
    virtual void check(const SonarConfig& /*config*/, types::Diagnostics& /*diagnostics*/) const {}
    /** Whether it takes part: adds its features and passes to the plan, else why it is left out. */
    virtual bool plan(const types::Geometry& geometry, RenderPlan& plan) const = 0;
    /** Names that it may add to RenderPlan::effect_features; each is HAVE_<NAME> in the shaders. */
    virtual std::vector<std::string> features() const { return {}; }
    /** What a user should know of it in this plan. */
    virtual void note(const RenderPlan& /*plan*/, const types::Geometry& /*geometry*/,
                      std::vector<std::string>& /*notices*/) const {}
    /** Of a plan in which it takes part; both outlive what is made. Null: nothing of its own happens in a ping. */
    virtual std::unique_ptr<PingEffect> make(const RenderPlan& /*plan*/, const types::Geometry& /*geometry*/) const {
        return nullptr;
    }
    /** Takes the effect out of a configuration, to measure what it does: its name; empty where it is not in it. */
    virtual std::string takeOut(SonarConfig& /*config*/) const { return {}; }
};

/** For Effect::plan(): leaves it out. */
inline bool leaveOut(RenderPlan& plan, const LeftOut& what) {
    plan.left_out.push_back(what);
    return false;
}

}  // namespace insonify::sonar
