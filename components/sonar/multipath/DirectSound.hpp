#pragma once
#include <optional>
#include <vector>

#include "components/sonar/beams/BeamFan.hpp"
#include "components/sonar/bins/EchoShape.hpp"
#include "components/sonar/multipath/TargetWays.hpp"
#include "components/sonar/multipath/Waveform.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

/** The pulses of other sonars that arrive at a sonar directly or via mirrors: the one-way sonar equation
 *  (ACOUSTICS.md 5.29). */
class DirectSound {
public:
    /** Plan and geometry outlive it; the plan has `crosstalk`. */
    DirectSound(const RenderPlan& plan, const types::Geometry& geometry);
    void takeScene(const types::Geometry& geometry);

    /** Adds the snapshot's transmissions to a ping whose beams are sorted. Returns the number of transmissions that any
     *  beam receives. */
    size_t add(const types::Snapshot& snapshot, types::Sonar& ping);

private:
    bool addWay(const types::Transmission& sent, const Reception& received, const TargetWay& way, types::Sonar& ping);
    /** Fills shares_ for bins from first_bin_. Returns whether there are any. */
    bool spread(double range, double length);
    /** Returns the receive power of a beam in a direction of the sonar's axes [1]. */
    double receivedBy(const Beam& beam, const BeamAngles& from, double range) const;

    const RenderPlan& plan_;
    Receiver receiver_;
    std::optional<TargetWays> ways_;
    std::optional<EchoShape> shape_;
    std::vector<Reception> received_;  ///< Receptions of the ping's transmissions.
    std::vector<double> shares_;       ///< Mean of the response in each bin [1].
    size_t first_bin_ = 0;
};

}  // namespace insonify::sonar
