#pragma once
#include <cstdint>
#include <optional>

#include "types/Describe.hpp"
#include "types/Sonar.hpp"

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
        visit({"threshold_db", "dB", "min level of a return, relative to the ping's strongest bin", -300, 0},
              self.threshold_db);
        visit({"floor_db", "dB", "absolute min level of a return, as 10 log10 of a bin; absent: none", -3000, 3000},
              self.floor_db);
    }
};

/** One return. */
struct Detection {
    double range;     ///< Slant range [m].
    float intensity;  ///< Intensity of its strongest bin [1].
    size_t bin;       ///< Number of its strongest bin [1].
};

/** Finds the returns in the beams of one ping (ACOUSTICS.md 5.16). */
class Detector {
public:
    /** Keeps a reference to the ping. */
    Detector(const DetectionConfig& config, const types::Sonar& ping);
    /** Returns the beam's strongest bin and the bins around it down to the gate, at their centre of mass. Each bin is
     *  weighted by its value times the square of its range. None where the strongest bin is below the threshold. */
    std::optional<Detection> strongest(uint32_t beam) const;
    /** Returns the beam's first bin that reaches the threshold, at its middle. */
    std::optional<Detection> first(uint32_t beam) const;

private:
    const types::Sonar& ping_;
    double bin_width_;   ///< [m]
    double minimum_;     ///< Min value of a return [1].
    double gate_share_;  ///< Min value of the other bins of a return, relative to its strongest bin [1].
};

}  // namespace insonify::sonar
