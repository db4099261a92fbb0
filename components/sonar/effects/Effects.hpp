#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "components/sonar/effects/Effect.hpp"

namespace insonify::sonar {

/** All effects, in the order in which they are planned, reported and run. */
std::span<const Effect* const> effects();

/** Adds an effect of a library to the end of the list; it stays until the process ends. Before any sonar is configured,
 *  from `insonify_register` or from main. One whose key is there already is not added. */
void addEffect(std::unique_ptr<const Effect> effect);

/** Diagnostics of SonarConfig::effects: keys and numbers that no effect has, numbers out of bounds; and of each effect.
 */
void checkEffects(const SonarConfig& config, types::Diagnostics& diagnostics);

/** The effects of a plan in the pings of one renderer, in order. */
class PingEffects {
public:
    /** Both outlive it. */
    PingEffects(const RenderPlan& plan, const types::Geometry& geometry);

    void takeQuality();
    void takeScene(const types::Geometry& geometry);
    void begin(const types::Snapshot& snapshot);
    void giveRules(EchoRules& rules) const;
    /** Why a compute shader cannot sum what they sum, a clause. Empty: it can. */
    std::string whyNotOnDevice() const;
    void addEchoes(PingInMaking& ping);
    void addToBins(types::Sonar& ping);
    size_t heard() const;  ///< [1]
    std::vector<LeftOut> leftOut() const;

private:
    std::vector<std::unique_ptr<PingEffect>> all_;
    std::vector<std::string> keys_;  ///< Effect::key() of each.
};

/** Adds to a cell's bins what the effects with sums of their own make of these. `sums`: all of the cell. */
void addOwnSums(const EchoRules& rules, const uint64_t* sums, size_t cell, double unit, std::span<float> bins);

}  // namespace insonify::sonar
