#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/sonar/plan/Effect.hpp"
#include "types/Check.hpp"
#include "types/text/Hash.hpp"

namespace insonify::sonar {
namespace {

constexpr double no_crosstalk_db = -200;  ///< The least that a configuration may give: none.

void checkBeams(const SonarConfig& config, types::Diagnostics& diagnostics) {
    const ImperfectionsConfig& own = *config.imperfections;
    const auto beams = static_cast<size_t>(std::max(1, config.beams()));
    checkPlaces("imperfections.dead_beams", own.dead_beams, beams, "beams", diagnostics);
    if (std::ranges::count(own.beamFactors(beams), 0.0f) == static_cast<std::ptrdiff_t>(beams))
        diagnostics.push_back({"imperfections", fmt::format("leaves none of {} beams alive", beams)});
}

/** Errors of the beams' channels and of the sampling clock, applied to complete bins. */
class ImperfectBeams final : public PingEffect {
public:
    explicit ImperfectBeams(const RenderPlan& plan)
        : plan_(plan),
          own_(*plan.config.imperfections),
          factors_(own_.beamFactors(plan.beams.size())),
          share_(own_.crosstalk_db && *own_.crosstalk_db > no_crosstalk_db
                     ? static_cast<float>(std::pow(10, *own_.crosstalk_db / 10))
                     : 0.0f) {}

    void addToBins(types::Sonar& ping) override {
        INSONIFY_CHECK(factors_.size() == ping.beam_count, factors_.size(), ping.beam_count);
        if (own_.clock_jitter_us > 0) jitter(ping);
        if (share_ > 0) mix(ping);
        for (size_t beam = 0; beam < ping.beam_count; ++beam) {
            const float factor = factors_[plan_.beams.row(beam)];
            if (factor == 1) continue;
            for (size_t k = 0; k < ping.bin_count; ++k) ping.bins[beam * ping.bin_count + k] *= factor;
        }
    }
    void addAlike(types::Sonar& bins) override { addToBins(bins); }

private:
    /** Samples all beams at erroneous times, interpolating linearly between bins. */
    void jitter(types::Sonar& ping) {
        kept_.assign(ping.bins.begin(), ping.bins.end());
        const auto count = static_cast<double>(ping.bin_count);
        const double bins_per_us = 1e-6 / (2 * ping.binSeconds());  // of the receiver's clock: two-way
        for (size_t k = 0; k < ping.bin_count; ++k) {
            const uint64_t word = types::hashed(own_.seed, static_cast<uint64_t>(ping.time.microseconds), k);
            const double late = types::normal(word) * own_.clock_jitter_us * bins_per_us;
            const double at = std::clamp(static_cast<double>(k) + late, 0.0, count - 1);
            const size_t low = std::min(static_cast<size_t>(at), size_t{ping.bin_count} - (ping.bin_count > 1 ? 2 : 1));
            const size_t high = std::min(low + 1, size_t{ping.bin_count} - 1);
            const auto part = static_cast<float>(at - static_cast<double>(low));
            for (size_t row = 0; row < ping.bins.size(); row += ping.bin_count)
                ping.bins[row + k] = kept_[row + low] + part * (kept_[row + high] - kept_[row + low]);
        }
    }
    /** Adds to each beam a share of its neighbours along the arc, or round the ring. */
    void mix(types::Sonar& ping) {
        kept_.assign(ping.bins.begin(), ping.bins.end());
        const size_t bins = ping.bin_count, last = kept_.size() - bins;
        for (size_t i = 0; i < kept_.size(); ++i) {
            if (i >= bins) ping.bins[i] += share_ * kept_[i - bins];
            if (i < last) ping.bins[i] += share_ * kept_[i + bins];
        }
        if (!plan_.beams.isRing()) return;
        for (size_t k = 0; k < bins; ++k) {
            ping.bins[k] += share_ * kept_[last + k];
            ping.bins[last + k] += share_ * kept_[k];
        }
    }

    const RenderPlan& plan_;
    ImperfectionsConfig own_;
    std::vector<float> factors_;  ///< Factor of each beam, in the ping's order.
    float share_;
    std::vector<float> kept_;
};

/** Errors of one device (ACOUSTICS.md 5.27). Those of elements and focus are in its directivity. */
class Imperfections final : public Effect {
public:
    void check(const SonarConfig& config, types::Diagnostics& diagnostics) const override {
        if (!config.imperfections) return;
        if (config.model == Model::Cerqueira2017)
            diagnostics.push_back({"imperfections", "is given with model: cerqueira2017; it belongs to physical"});
        checkBeams(config, diagnostics);
    }
    bool plan(const types::Geometry& /*geometry*/, RenderPlan& plan) const override {
        return plan.config.imperfections || leaveOut(plan, {"imperfections", Reason::NotConfigured});
    }
    std::unique_ptr<PingEffect> make(const RenderPlan& plan, const types::Geometry& /*geometry*/) const override {
        return std::make_unique<ImperfectBeams>(plan);
    }
    std::string removeFrom(SonarConfig& config) const override {
        return removeBlock(config.imperfections, "imperfections");
    }
};

}  // namespace

const Effect& imperfections() { return only<Imperfections>(); }

}  // namespace insonify::sonar
