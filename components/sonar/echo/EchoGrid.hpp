#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "components/sonar/ThreadPool.hpp"
#include "components/sonar/echo/Beamformer.hpp"
#include "components/sonar/echo/RangeResponse.hpp"
#include "components/sonar/plan/RenderPlan.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

/** Of a plan that forms beams. */
Beamformer beamformerOf(const RenderPlan& plan);

/** Rules of a beamformer of a plan's beams with `samples` in range: those of the directivity's zones. */
Beamformer::Rules rulesOfZones(const RenderPlan& plan, size_t samples,
                               const std::function<Beamformer::Rules(size_t zone)>& zoneRules);

/** The way of echoes from azimuth cells to the bins of a ping: beams are formed of the cells, and the pulse spreads
 *  them in range. Of a plan without either, cells are the ping's beams, and there is no work. */
class EchoGrid {
public:
    /** `threads`: of the pool that will finish it. */
    EchoGrid(const RenderPlan& plan, int threads);

    /** Where the intensities of a cell go, one for each bin; each cell's are filled once a ping. */
    std::span<float> cell(size_t cell, types::Sonar& ping) {
        return {passes() ? ping.bins.data() + cell * bin_count_ : echoes_.data() + cell * bin_count_, bin_count_};
    }
    /** Once all cells are filled. Allocates nothing. */
    void finish(types::Sonar& ping, ThreadPool& threads);

private:
    bool passes() const { return !beamformer_ && !response_; }
    void finishBeam(size_t beam, std::span<float> padded, types::Sonar& ping) const;

    size_t bin_count_, beam_count_;
    std::optional<Beamformer> beamformer_;
    std::optional<RangeResponse> response_;
    std::vector<float> echoes_;               ///< [cell][bin].
    std::vector<std::vector<float>> padded_;  ///< Of each thread: a beam with the response's margins.
};

}  // namespace insonify::sonar
