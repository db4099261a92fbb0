#pragma once
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "types/Time.hpp"
#include "types/text/Describe.hpp"

namespace insonify::types {

/** The signals of the elements of a straight array for one ping, as complex baseband after the pulse's matched filter.
 *  They do not contain point targets, mirrors and ring-down. The squared magnitude is the intensity relative to the
 *  source; the phase rotates by exp(i 4 pi r / wavelength) along the range. Sample i of element m is at index [m *
 *  sample_count + i] of `in_phase` and `quadrature`. */
struct SonarElements {
    static constexpr const char* type_name = "/insonify/SonarElements";
    static constexpr bool shared = true;  ///< Travels by reference, see Carried.

    Time time;
    double speed_of_sound = 0;
    double wavelength = 0;
    double first_range = 0;
    double sample_spacing = 0;
    uint32_t sample_count = 0;
    std::vector<double> positions;
    std::vector<double> weights;
    std::vector<float> in_phase;
    std::vector<float> quadrature;

    std::vector<size_t> shape() const { return {positions.size(), sample_count}; }
    /** Returns the slant range of a sample [m]. */
    double range(size_t sample) const { return first_range + static_cast<double>(sample) * sample_spacing; }
    /** Returns the error of the lists, as the rest of a sentence after "a sample"; null when there is none. */
    const char* diagnostic() const;

    /** Calls `visit` for the lists with a number for each sample, with the type of the numbers in files. */
    static void forEachArray(auto& self, auto&& visit) {
        visit("in_phase", self.in_phase, std::type_identity<float>{});
        visit("quadrature", self.quadrature, std::type_identity<float>{});
    }
    static void describe(auto& self, auto& visit) {
        visit({"time", "us", "when the ping was true in the world"}, self.time);
        visit({"speed_of_sound", "m/s", "speed of sound that turns time into range"}, self.speed_of_sound);
        visit({"wavelength", "m", "of the carrier"}, self.wavelength);
        visit({"first_range", "m", "slant range of the first sample"}, self.first_range);
        visit({"sample_spacing", "m", "slant range from one sample to the next"}, self.sample_spacing);
        visit({"sample_count", "1", "samples of each element"}, self.sample_count);
        visit({"positions", "m", "of each element from the array's middle, positive to port"}, self.positions);
        visit({"weights", "1", "of each element where the sonar forms its own beams; their sum is 1"}, self.weights);
        visit({"in_phase", "1/m", "real part of the field, element by element"}, self.in_phase);
        visit({"quadrature", "1/m", "imaginary part of the field, element by element"}, self.quadrature);
    }
};
using SonarElementsPtr = std::shared_ptr<const SonarElements>;

inline const char* SonarElements::diagnostic() const {
    const size_t count = positions.size() * sample_count;
    if (weights.size() != positions.size()) return "has other numbers of weights than elements";
    return in_phase.size() == count && quadrature.size() == count ? nullptr
                                                                  : "has other numbers of samples than it says";
}

}  // namespace insonify::types
