#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/geometry/Geometry.hpp"
#include "types/geometry/Snapshot.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::sonar {

class EchoField;
class RayPaths;
struct TracedPing;
struct TracedTile;
struct EchoRules;
struct Cells;
struct Covered;

/** A ping that begins. */
struct PingStart {
    const types::Snapshot& snapshot;
    types::SonarTruth* truth;  ///< Filled with what the bins show; null where no truth is recorded.
};

/** A batch of cells whose echoes are summed, with the sums of one effect. */
struct CellBatch {
    const EchoRules& rules;
    const WaterView& water;
    const Cells& cells;
    const Covered& covered;
    int first_beam;      ///< Beam of the first sums [1].
    uint64_t* own;       ///< Sums of the first beam in whole quanta, one for each bin and one behind the last bin.
    size_t beam_stride;  ///< Numbers from the sums of one beam to the sums of the next beam [1].
};

/** A ping that has the echoes of its surfaces. */
struct PingInMaking {
    const types::Snapshot& snapshot;
    types::Sonar& ping;        ///< Its bins hold intensities of the sorted beams, unless `field` is given.
    EchoField* field;          ///< The field that is squared into the bins; null where energies are summed.
    const RayPaths* bent;      ///< The sound paths; null where they are straight.
    types::SonarTruth* truth;  ///< That of its surfaces, of the sorted beams; null where no truth is recorded.

    /** Records that most of a bin is the echo of neither a surface nor the water, and whether it has passed walls. */
    void report(size_t bin, bool passes_walls) const;
};

/** An effect in the pings of one renderer, with the state that it keeps from ping to ping. No call for a ping
 *  allocates after the first pings. */
class PingEffect {
public:
    virtual ~PingEffect() = default;

    bool is_silent = false;  ///< Whether echoes of its own are not received in this ping (EchoSelection).

    /** Switches to the plan's current quality. May allocate. */
    virtual void updateQuality() {}
    /** Switches to another scene with the same materials. The scene before ends its life after the call. */
    virtual void setScene(const types::Geometry& /*geometry*/) {}
    /** Takes new shapes of deforming meshes. They changed in place, in the objects that this and earlier snapshots
     *  deform. Called before begin() if any mesh deforms. */
    virtual void updateShapes(const types::Snapshot& /*snapshot*/) {}
    /** Begins a ping, before all else. */
    virtual void begin(const PingStart& /*start*/) {}

    /** Adds the effect's numbers to the rules by which cells are summed. */
    virtual void giveRules(EchoRules& /*rules*/) const {}
    /** Returns whether addCells() and addToCell() are called, with one sum for each bin of a beam. The truth records
     *  such echoes as those of the water. */
    virtual bool hasSums() const { return false; }
    /** Returns whether the compute shader makes the same sums. It can do so for one effect. With two or more, images
     *  are summed on the processor. A notice reports it where the device was to sum them. */
    virtual bool isOnDevice() const { return false; }
    /** Adds a batch of cells to the effect's sums. Several threads call it. */
    virtual void addCells(const CellBatch& /*batch*/) const {}
    /** Turns a cell's sums into intensities and adds these to the cell's bins. `unit` is the solid angle of a whole
     *  sample [sr]. Several threads call it. */
    virtual void addToCell(const uint64_t* /*sums*/, size_t /*cell*/, double /*unit*/,
                           std::span<float> /*bins*/) const {}

    /** Returns whether followRays(), addEnergies() and addToTruth() are called in pings that are ray-traced. */
    virtual bool followsRays() const { return false; }
    /** Follows rays beyond their hits, before their tiles are summed. May change the hits. Several threads call it,
     *  each with its own tiles. */
    virtual void followRays(const TracedPing& /*ping*/, std::span<const TracedTile> /*tiles*/) {}
    /** Adds to the intensities of a cell's bins once the rays of all cells are followed. Where fields are summed, the
     *  bins are 0 before. Returns whether it has added any. Called once for each cell, by several threads. */
    virtual bool addEnergies(const TracedPing& /*ping*/, size_t /*cell*/, std::span<float> /*bins*/) { return false; }
    /** Adds to the truth of a ping, whose beams are sorted, once the truth of its surfaces is complete. */
    virtual void addToTruth(const TracedPing& /*ping*/, types::SonarTruth& /*truth*/) {}

    /** Adds echoes to beams, before fields are squared. */
    virtual void addEchoes(PingInMaking& /*ping*/) {}
    /** Changes the bins of a ping that has all its echoes. */
    virtual void addToBins(types::Sonar& /*ping*/) {}
    /** Does to bins the part of addToBins() that concerns what every beam records alike, whatever it looks at: the
     *  transmitter's own ringing. Tasks that sum beams count it once. */
    virtual void addAlike(types::Sonar& /*bins*/) {}

    /** Returns the number of things, other than surfaces, of which the last ping has an echo [1]. */
    virtual size_t received() const { return 0; }
    /** Returns what the effect omitted in the last ping; none before the first ping. */
    virtual std::optional<Omitted> omissions() const { return {}; }
};

/** An effect of a sonar's configuration or scene on its pings, in one file. The list of effects (Effects.hpp) is the
 *  plan: the features and passes, and what is omitted for which reason. */
class Effect {
public:
    virtual ~Effect() = default;

    /** Returns the key of its numbers in SonarConfig::effects; empty where it reads other fields of the configuration.
     */
    virtual std::string key() const { return {}; }
    /** Returns the name, unit, meaning and bounds of each of its numbers. */
    virtual std::vector<types::Field> numbers() const { return {}; }
    /** Adds a diagnostic for each contradiction in a configuration. */
    virtual void check(const SonarConfig& /*config*/, types::Diagnostics& /*diagnostics*/) const {}
    /** Adds its features and passes to the plan and returns true, or adds the reason for omitting it and returns false.
     */
    virtual bool plan(const types::Geometry& geometry, RenderPlan& plan) const = 0;
    /** Returns all names that it may add to RenderPlan::effect_features. Each is HAVE_<NAME> in the shaders. */
    virtual std::vector<std::string> features() const { return {}; }
    /** Adds the notices about the effect in this plan. */
    virtual void note(const RenderPlan& /*plan*/, const types::Geometry& /*geometry*/,
                      types::Notices& /*notices*/) const {}
    /** Adds to what is known of the bins of a configured sonar. */
    virtual void addTo(types::ReturnRules& /*rules*/, const SonarConfig& /*config*/) const {}
    /** Returns the greatest mean intensity that each bin of a ping receives of it without any surface, in the ping's
     *  order; empty: none. */
    virtual std::vector<float> withoutSurfaces(const RenderPlan& /*plan*/) const { return {}; }
    /** Makes the effect's part in the pings of a plan that includes it. Plan and geometry outlive the result. Null
     *  where the effect does nothing in a ping. */
    virtual std::unique_ptr<PingEffect> make(const RenderPlan& /*plan*/, const types::Geometry& /*geometry*/) const {
        return nullptr;
    }
    /** Removes the effect from a configuration, to measure its influence. Returns its name; empty where the
     *  configuration does not have it. */
    virtual std::string removeFrom(SonarConfig& /*config*/) const { return {}; }
};

/** Returns whether sonar and objects move while sound travels. */
bool followsMotion(const SonarConfig& config);

/** Omits an effect, for Effect::plan(). */
inline bool leaveOut(RenderPlan& plan, const Omitted& what) {
    plan.omitted.push_back(what);
    return false;
}

/** Removes an optional block of a configuration, for Effect::removeFrom(). Returns the effect's name; empty where the
 * block is absent. */
std::string removeBlock(auto& block, const char* name) {
    if (!block) return {};
    block.reset();
    return name;
}

/** Returns the only object of an effect's class. */
template <class Kind>
const Effect& only() {
    static const Kind effect;
    return effect;
}

/** Adds a diagnostic for each entry of a list that is not an index of one of `count` things. */
void checkPlaces(const char* path, const std::vector<uint32_t>& list, size_t count, const char* things,
                 types::Diagnostics& diagnostics);

}  // namespace insonify::sonar
