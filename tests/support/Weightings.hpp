#pragma once
// Textbook values of the weightings of an aperture.
#include <optional>

#include "components/acoustics/BeamPattern.hpp"

namespace insonify::test {

inline acoustics::BeamLaw getLaw(acoustics::Weighting weighting, double width_deg) {
    acoustics::BeamLaw law;
    law.weighting = weighting;
    law.width_deg = width_deg;
    return law;
}

/** Values of a weighting (Harris 1978, Taylor 1955, Dolph 1946): widths and the first null in wavelengths over the
 *  length of the aperture, and integrals of the one-way and two-way power over u. */
struct WeightingRow {
    const char* name;
    acoustics::Weighting weighting;
    double width, two_way_width;
    std::optional<double> sidelobe_db;
    std::optional<int> nbar;
    double first_null, peak_sidelobe_db;
    std::optional<double> integral = {}, two_way_integral = {};

    /** Returns a law without a width. */
    acoustics::BeamLaw law() const {
        acoustics::BeamLaw law;
        law.weighting = weighting;
        law.sidelobe_db = sidelobe_db;
        law.nbar = nbar;
        return law;
    }
};

inline const WeightingRow weightings[] = {
    {"uniform", acoustics::Weighting::Uniform, 0.8859, 0.6378, {}, {}, 1.00, -13.26, 1.000, 0.667},
    {"cosine", acoustics::Weighting::Cosine, 1.189, 0.851, {}, {}, 1.50, -23.0, 1.234, 0.893},
    {"hann", acoustics::Weighting::Hann, 1.4406, 1.028, {}, {}, 2.00, -31.5, 1.500, 1.083},
    {"hamming", acoustics::Weighting::Hamming, 1.303, 0.928, {}, {}, 2.00, -42.7, 1.363, 0.980},
    {"taylor 25", acoustics::Weighting::Taylor, 1.057, 0.756, -25, 4, 1.35, -25.4, 1.104, 0.793},
    {"taylor 30", acoustics::Weighting::Taylor, 1.125, 0.804, -30, 4, 1.51, -30.3, 1.172, 0.845},
    {"taylor 35", acoustics::Weighting::Taylor, 1.188, 0.848, -35, 5, 1.67, -35.2, 1.238, 0.892},
    {"piston", acoustics::Weighting::Piston, 1.029, 0.739, {}, {}, 1.22, -17.6},
};

}  // namespace insonify::test
