#pragma once
#include <complex>
#include <cstdint>
#include <optional>
#include <vector>

#include "types/Describe.hpp"

namespace insonify::sonar {

/** Errors of one device compared with an ideal device, drawn at random from a seed. They are the same for the device's
 *  whole life (ACOUSTICS.md 5.27). Values of 0, empty lists and absent values give an ideal device. */
struct ImperfectionsConfig {
    uint32_t seed = 1;
    std::optional<int> elements = {};
    double gain_error_db = 0, phase_error_deg = 0, dead_element_share = 0;
    std::vector<uint32_t> dead_elements = {};
    std::optional<double> focus_m = {};
    double beam_gain_error_db = 0, dead_beam_share = 0;
    std::vector<uint32_t> dead_beams = {};
    std::optional<double> crosstalk_db = {};
    double clock_jitter_us = 0;

    /** Returns whether elements of the receiving array differ from ideal elements. */
    bool hasElementErrors() const {
        return gain_error_db > 0 || phase_error_deg > 0 || dead_element_share > 0 || !dead_elements.empty();
    }
    /** Returns the factors of the signals of `count` elements: (gain) exp(i phase), 0 for a dead element. */
    std::vector<std::complex<double>> elementFactors(size_t count) const;
    /** Returns the factors of the intensities of `count` beams, 0 for a dead beam. */
    std::vector<float> beamFactors(size_t count) const;

    static void describe(auto& self, auto& visit) {
        visit({"seed", "1", "seed of the errors; each device has its own", 0, 4294967295.0}, self.seed);
        visit({"elements", "1",
               "elements of the receiving array; absent: those of `elements`, or half a wavelength apart", 2, 4096},
              self.elements);
        visit({"gain_error_db", "dB", "standard deviation of the elements' gains", 0, 20}, self.gain_error_db);
        visit({"phase_error_deg", "deg", "standard deviation of the elements' phases", 0, 180}, self.phase_error_deg);
        visit({"dead_element_share", "1", "probability that an element is dead", 0, 1}, self.dead_element_share);
        visit({"dead_elements", "1", "further dead elements, counted from starboard, the first is 0", 0, 4095},
              self.dead_elements);
        visit({"focus_m", "m",
               "fixed focus of the receiving array; nearer and farther echoes bloom; needs frequency_khz; absent: "
               "focused at every range",
               0.01, 1e5},
              self.focus_m);
        visit({"beam_gain_error_db", "dB", "standard deviation of the beams' gains", 0, 20}, self.beam_gain_error_db);
        visit({"dead_beam_share", "1", "probability that a beam is dead", 0, 1}, self.dead_beam_share);
        visit({"dead_beams", "1", "further dead beams, in the ping's order, the first is 0", 0, 4095}, self.dead_beams);
        visit({"crosstalk_db", "dB", "power of a beam that leaks into each of its neighbours; absent: none", -200, 0},
              self.crosstalk_db);
        visit({"clock_jitter_us", "us",
               "standard deviation of the receiver's times at which bins are sampled, there and back", 0, 1e5},
              self.clock_jitter_us);
    }
};

}  // namespace insonify::sonar
