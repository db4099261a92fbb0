#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/beams/BinGrid.hpp"
#include "components/sonar/bins/Accumulator.hpp"
#include "components/sonar/bins/Beamformer.hpp"
#include "components/sonar/plan/RenderPlan.hpp"

namespace insonify::sonar {

/** Returns the beamformer of a plan that forms beams. */
Beamformer beamformer(const RenderPlan& plan);

/** Returns the rules of beams that receive their boxes, times what is sent. `sent`: power, or field. */
Beamformer::Rules boxRules(Beamformer::Pattern sent, const RenderPlan& plan, bool of_fields = false);

/** Returns the rules of a beamformer of a plan's beams with `samples` in range, by the directivity's zones. */
Beamformer::Rules rulesOfZones(const RenderPlan& plan, size_t samples,
                               const std::function<Beamformer::Rules(size_t zone)>& zoneRules);

/** Energies of azimuth cells, of which beams are formed, and which the pulse spreads in range. In a plan without
 * either, cells are the ping's beams, and are filled in place. */
class EchoGrid final : public Accumulator {
public:
    EchoGrid(const RenderPlan& plan, int threads);
    void setQuality(const RenderPlan& plan) override;
    void begin(const types::Snapshot& snapshot, types::Sonar& ping) override;
    bool fill(size_t cell, const EchoRules& rules, const uint64_t* sums, double solid_angle, size_t thread) override;
    std::span<float> energies(size_t cell, size_t /*thread*/) override {
        return {(passes() ? bins_ : echoes_.data()) + cell * bin_count_, bin_count_};
    }
    void finish(ThreadPool& threads) override;

private:
    bool passes() const { return !beamformer_ && !response_; }
    void finishBeam(size_t beam, std::span<float> padded) const;

    size_t bin_count_, beam_count_;
    float* bins_ = nullptr;  ///< Of the ping.
    std::optional<Beamformer> beamformer_;
    std::optional<RangeResponse> response_;
    std::vector<float> echoes_;               ///< [cell][bin].
    std::vector<std::vector<float>> padded_;  ///< One padded beam per thread, including the margins of the response.
};

}  // namespace insonify::sonar
