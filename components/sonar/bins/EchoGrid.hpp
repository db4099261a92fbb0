#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/base/ThreadPool.hpp"
#include "components/sonar/beams/RangeResponse.hpp"
#include "components/sonar/bins/Beamformer.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

/** Returns the beamformer of a plan that forms beams. */
Beamformer beamformerOf(const RenderPlan& plan);

/** Returns the rules of beams that receive their boxes, times what is sent. `sent`: power, or field. */
Beamformer::Rules boxRules(Beamformer::Pattern sent, const RenderPlan& plan, bool of_fields = false);

/** Returns the rules of a beamformer of a plan's beams with `samples` in range, by the directivity's zones. */
Beamformer::Rules rulesOfZones(const RenderPlan& plan, size_t samples,
                               const std::function<Beamformer::Rules(size_t zone)>& zoneRules);

/** Transfers echoes from azimuth cells to the bins of a ping: beams are formed of the cells, and the pulse spreads them
 *  in range. In a plan without either, cells are the ping's beams, and there is no work. */
class EchoGrid {
public:
    /** `threads`: size of the pool that will finish it. */
    EchoGrid(const RenderPlan& plan, int threads);
    /** Switches to the same plan with other azimuth cells. */
    void takeQuality(const RenderPlan& plan);

    /** Returns the buffer for the intensities of a cell, one for each bin; each cell is filled once per ping. */
    std::span<float> cell(size_t cell, types::Sonar& ping) {
        return {passes() ? ping.bins.data() + cell * bin_count_ : echoes_.data() + cell * bin_count_, bin_count_};
    }
    /** Finishes the ping once all cells are filled. Allocates nothing. */
    void finish(types::Sonar& ping, ThreadPool& threads);

private:
    bool passes() const { return !beamformer_ && !response_; }
    void finishBeam(size_t beam, std::span<float> padded, types::Sonar& ping) const;

    size_t bin_count_, beam_count_;
    std::optional<Beamformer> beamformer_;
    std::optional<RangeResponse> response_;
    std::vector<float> echoes_;               ///< [cell][bin].
    std::vector<std::vector<float>> padded_;  ///< One padded beam per thread, including the margins of the response.
};

}  // namespace insonify::sonar
