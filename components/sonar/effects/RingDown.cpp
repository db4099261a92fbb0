#include "components/sonar/plan/Effect.hpp"

namespace insonify::sonar {
namespace {

/** The transmitter's ring-down in the first bins of every beam. */
class RingDownInPings final : public PingEffect {
public:
    explicit RingDownInPings(const RenderPlan& plan) {
        for (int k = 0; k < plan.grid.bin_count; ++k) {
            const double received = plan.config.pulse->ring_down->mean(plan.grid.edge(k), plan.grid.edge(k + 1));
            if (static_cast<float>(received) == 0) return;
            bins_.push_back(static_cast<float>(received));
        }
    }
    void addToBins(types::Sonar& ping) override {
        for (size_t beam = 0; beam < ping.beam_count; ++beam)
            for (size_t k = 0; k < bins_.size(); ++k) ping.bins[beam * ping.bin_count + k] += bins_[k];
    }
    void addAlike(types::Sonar& bins) override { addToBins(bins); }

private:
    std::vector<float> bins_;  ///< The ring-down in the first bins of every beam.
};

/** The transmit ring-down (ACOUSTICS.md 5.15). */
class RingDown final : public Effect {
public:
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        if (!plan.config.pulse || !plan.config.pulse->ring_down)
            return leaveOut(plan, {"transmit ring-down", Reason::NotConfigured});
        plan.add(Pass::RingDown);
        return true;
    }
    std::unique_ptr<PingEffect> make(const RenderPlan& plan, const types::Geometry& /*geometry*/) const override {
        return std::make_unique<RingDownInPings>(plan);
    }
    void addTo(types::ReturnRules& rules, const SonarConfig& config) const override {
        if (!config.pulse || !config.pulse->ring_down) return;
        rules.ring_down_db = *config.pulse->ring_down->level_db;
        rules.ring_down_db_per_m = *config.pulse->ring_down->decay_db_per_m;
    }
    std::string takeOut(SonarConfig& config) const override {
        if (!config.pulse || !config.pulse->ring_down) return {};
        config.pulse->ring_down.reset();
        return "transmit ring-down";
    }
};

}  // namespace

const Effect& ringDown() { return only<RingDown>(); }

}  // namespace insonify::sonar
