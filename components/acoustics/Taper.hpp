#pragma once
#include "types/Describe.hpp"

namespace insonify::acoustics {

/** The weighting of the parts of an aperture, or of a band. */
enum class Weighting { Uniform, Cosine, Hann, Hamming, Taylor, Dolph, Gaussian, Piston };

/** The far field of a weighted aperture, or the response of the matched filter of a weighted band. It is the Fourier
 *  transform of the weighting over u, 1 at 0. For a line of length L, u = L / wavelength sin(angle); for a disc L is
 *  its diameter; for a band B, u is B times the delay. ACOUSTICS.md 5.8. */
class Taper {
public:
    /** @param sidelobe_db depth of the sidelobes of Taylor and Dolph, either sign [dB]
     *  @param nbar number of Taylor's equal sidelobes
     *  @param elements number of elements of Dolph's array */
    explicit Taper(Weighting weighting, double sidelobe_db = -30, int nbar = 4, int elements = 64);

    double amplitude(double u) const;
    double power(double u) const { return amplitude(u) * amplitude(u); }
    /** Returns the width of the main lobe at half its power, both sides [u]. */
    double halfPowerWidth() const;

private:
    double taylor(double u) const;
    double dolph(double u) const;

    Weighting weighting_;
    double ratio_;  ///< Amplitude of the main lobe over that of the sidelobes [1].
    int nbar_, elements_;
};

}  // namespace insonify::acoustics

template <>
struct insonify::types::EnumNames<insonify::acoustics::Weighting> {
    static constexpr std::string_view names[] = {"uniform", "cosine", "hann",     "hamming",
                                                 "taylor",  "dolph",  "gaussian", "piston"};
};
