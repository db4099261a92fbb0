#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "types/Describe.hpp"
#include "types/Sonar.hpp"

namespace insonify::sonar {

/** What is a return, and which bins belong to it. */
struct DetectionConfig {
    double threshold_db = -60;
    std::optional<double> floor_db;
    double gate_db = 10;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        describeThreshold(self, visit);
        visit(Field{"gate_db", "dB", "bins beside the strongest belong to a return down to so far below it", 0.1, 300},
              self.gate_db);
    }
    /** What an altimeter has as well. */
    template <class Self, class V>
    static void describeThreshold(Self& self, V& visit) {
        using types::Field;
        visit(Field{"threshold_db", "dB", "what is a return, relative to the ping's strongest bin", -300, 0},
              self.threshold_db);
        visit(Field{"floor_db", "dB", "what is one in any ping, as 10 log10 of a bin; absent: no such floor", -3000,
                    3000},
              self.floor_db);
    }
};

/** One return. */
struct Detection {
    double range;     ///< Slant range [m].
    float intensity;  ///< Of its strongest bin [1].
    size_t bin;       ///< Number of that bin [1].
};

/** Finds the returns in the beams of one ping (ACOUSTICS.md 5.16). */
class Detector {
public:
    /** Keeps a reference to the ping, whose bins are exactly so wide [m]: `bin_duration` is rounded. */
    Detector(const DetectionConfig& config, const types::Sonar& ping, double bin_width);
    /** The beam's strongest bin and those around it down to the gate: at their centre of mass, each bin weighing what
     *  it holds times the square of its range. None where the strongest is below the threshold. */
    std::optional<Detection> strongest(uint32_t beam) const;
    /** The beam's first bin that reaches the threshold, at its middle. */
    std::optional<Detection> first(uint32_t beam) const;

private:
    const types::Sonar& ping_;
    double bin_width_;   ///< [m]
    double least_;       ///< Of a return [1].
    double gate_share_;  ///< Of the strongest bin, that others of its return have [1].
};

}  // namespace insonify::sonar
