#pragma once
#include <complex>
#include <cstdint>
#include <optional>
#include <vector>

#include "types/Describe.hpp"

namespace insonify::sonar {

/** What one device has that an ideal one does not, drawn by a seed: the same for the device's whole life
 *  (ACOUSTICS.md 5.27). Values of 0, empty lists and absent values are an ideal device. */
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

    /** Whether elements of the receiving array differ from ideal ones. */
    bool hasElementErrors() const {
        return gain_error_db > 0 || phase_error_deg > 0 || dead_element_share > 0 || !dead_elements.empty();
    }
    /** By what each of `count` elements multiplies its signal: (gain) exp(i phase), 0 where it is dead. */
    std::vector<std::complex<double>> elementFactors(size_t count) const;
    /** By what each of `count` beams multiplies its intensities, 0 where it is dead. */
    std::vector<float> beamFactors(size_t count) const;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"seed", "1", "of the errors: one device has one seed", 0, 4294967295.0}, self.seed);
        visit(
            Field{"elements", "1",
                  "elements of the receiving array; absent: those of `elements`, or half a wavelength apart", 2, 4096},
            self.elements);
        visit(Field{"gain_error_db", "dB", "standard deviation of the elements' gains", 0, 20}, self.gain_error_db);
        visit(Field{"phase_error_deg", "deg", "standard deviation of the elements' phases", 0, 180},
              self.phase_error_deg);
        visit(Field{"dead_element_share", "1", "probability that an element is dead", 0, 1}, self.dead_element_share);
        visit(Field{"dead_elements", "1", "elements that are dead as well, from starboard, the first is 0", 0, 4095},
              self.dead_elements);
        visit(Field{"focus_m", "m",
                    "range to which the receiving array is focused for good; nearer and farther echoes bloom; needs "
                    "frequency_khz; absent: focused at every range",
                    0.01, 1e5},
              self.focus_m);
        visit(Field{"beam_gain_error_db", "dB", "standard deviation of the beams' gains", 0, 20},
              self.beam_gain_error_db);
        visit(Field{"dead_beam_share", "1", "probability that a beam is dead", 0, 1}, self.dead_beam_share);
        visit(Field{"dead_beams", "1", "beams that are dead as well, as the ping counts them, the first is 0", 0, 4095},
              self.dead_beams);
        visit(
            Field{"crosstalk_db", "dB", "power of a beam that is in each of its neighbours too; absent: none", -200, 0},
            self.crosstalk_db);
        visit(Field{"clock_jitter_us", "us", "standard deviation of the times at which bins are sampled", 0, 1e5},
              self.clock_jitter_us);
    }
};

}  // namespace insonify::sonar
