#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "components/sonar/plan/RenderPlan.hpp"
#include "types/ReturnLevels.hpp"
#include "types/samples/Sonar.hpp"
#include "types/text/Describe.hpp"

namespace insonify::sonar {

/** Criteria of a return, and of the bins that belong to it. */
struct DetectionConfig {
    double threshold_db = -60;
    std::optional<double> floor_db;
    double gate_db = 10;

    static void describe(auto& self, auto& visit) {
        describeThreshold(self, visit);
        visit({"gate_db", "dB", "bins around the strongest belong to a return down to this level below it", 0.1, 300},
              self.gate_db);
    }
    /** Describes the properties that an altimeter has as well. */
    static void describeThreshold(auto& self, auto& visit) {
        visit({"threshold_db", "dB", "min level of a return without spreading, relative to the strongest of the ping",
               -300, 0},
              self.threshold_db);
        visit({"floor_db", "dB", "absolute min level of a return, as 10 log10 of a bin; absent: none", -3000, 3000},
              self.floor_db);
    }
};

/** One return. */
struct Detection {
    double range;     ///< Slant range, not nearer than the sonar's `range_min` [m].
    float intensity;  ///< Intensity of its strongest bin [1].
    double level;     ///< Level of that bin, without spreading and absorption [1].
    size_t bin;       ///< Number of its strongest bin [1].
};

/** What a detector knows of the pings of one sonar. */
struct DetectionRules {
    types::ReturnRules returns;
    /** Max value of each bin that is no return but an echo of the water, beam-first; empty: there is none. */
    std::vector<float> water;

    static DetectionRules of(const RenderPlan& plan);
};

/** Finds the returns in the beams of one ping as devices do (ACOUSTICS.md 5.16): spreading and absorption are removed,
 *  and so are blanked bins, the ring-down, and what is no stronger than the water. */
class Detector {
public:
    /** Computes the levels of a ping, which must live on. Allocates nothing for the shape of the last ping. */
    void take(const types::Sonar& ping, const DetectionConfig& config, const DetectionRules& rules);
    /** Returns the beam's strongest bin and the bins around it down to the gate, at their centre of mass. Each bin is
     *  weighted by its echo times the square of its range. None where the strongest bin is below the threshold. */
    std::optional<Detection> strongest(uint32_t beam) const;
    /** Returns the beam's first bin that reaches the threshold, at its middle. */
    std::optional<Detection> first(uint32_t beam) const;

private:
    Detection at(uint32_t beam, double place, size_t bin) const;

    const types::Sonar* ping_ = nullptr;
    double gate_share_ = 1;  ///< Min level of the other bins of a return, relative to its strongest bin [1].
    types::ReturnLevels tables_;
    double range_min_ = 0;        ///< Of the sonar: the bin that it divides has echoes of its farther part [m].
    std::vector<double> levels_;  ///< Of each bin, 0 where it is no return.
    double minimum_ = 0;          ///< Min level of a return [1].
};

}  // namespace insonify::sonar
