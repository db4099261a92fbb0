#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {

/** Returns all effects, in the order in which they are planned, reported and run. Stays valid; effects that are added
 *  later are in later results. */
std::span<const Effect* const> effects();

/** Adds an effect of a library to the end of the list, until the process ends. Call it before the sonars that use it
 *  are configured, from `insonify_register` or from main, on any thread. Does nothing where the list has an effect
 *  with the same key. Throws std::length_error above 256 effects. */
void addEffect(std::unique_ptr<const Effect> effect);

/** Throws the exception that is being handled again, with the name of an effect that has a key. */
[[noreturn]] void failIn(const Effect& effect);

/** Calls a part of an effect; see failIn(). Allocates nothing. */
void calling(const Effect& effect, auto&& part) {
    try {
        part();
    } catch (...) {
        failIn(effect);
    }
}

/** Adds diagnostics of SonarConfig::effects: unknown keys and numbers, numbers out of bounds. Adds those of each
 *  effect, Effect::check(). */
void checkEffects(const SonarConfig& config, types::Diagnostics& diagnostics);

/** The effects of a plan in the pings of one renderer, in order. */
class PingEffects {
public:
    /** Plan and geometry outlive the effects. */
    PingEffects(const RenderPlan& plan, const types::Geometry& geometry);

    void updateQuality();
    void setScene(const types::Geometry& geometry);
    void updateShapes(const types::Snapshot& snapshot);
    void begin(const PingStart& start);
    void giveRules(EchoRules& rules) const;
    /** Returns why a compute shader cannot make the sums of the effects, as a clause. Empty: it can. */
    std::string whyNotOnDevice() const;
    bool followsRays() const;
    void followRays(const TracedPing& ping, std::span<const TracedTile> tiles);
    bool addEnergies(const TracedPing& ping, size_t cell, std::span<float> bins);
    void addToTruth(const TracedPing& ping, types::SonarTruth& truth);
    void addEchoes(PingInMaking& ping);
    void addToBins(types::Sonar& ping);
    void addAlike(types::Sonar& bins);
    size_t received() const;  ///< [1]
    std::vector<Omitted> omissions() const;

private:
    std::vector<std::unique_ptr<PingEffect>> all_;
    std::vector<const Effect*> kinds_;  ///< Of each.
    EchoSelection* selection_;
};

/** Adds to a cell's bins the intensities of effects with their own sums. `sums` contains all sums of the cell. */
void addOwnSums(const EchoRules& rules, const uint64_t* sums, size_t cell, double unit, std::span<float> bins);

}  // namespace insonify::sonar
