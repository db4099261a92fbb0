#pragma once
#include "types/Describe.hpp"

namespace insonify::acoustics {

/** How strongly the parts of an aperture, or of a band, take part. */
enum class Weighting { Uniform, Cosine, Hann, Hamming, Taylor, Dolph, Gaussian, Piston };

/** The far field of a weighted aperture, or the matched filter's answer of a weighted band: its Fourier transform over
 *  u, 1 at 0. For a line of length L, u = L / wavelength sin(angle); for a disc L is its diameter; for a band B, u is B
 *  times the delay. ACOUSTICS.md 14.1. */
class Taper {
public:
    /** `sidelobe_db`: depth of the sidelobes of Taylor and Dolph, either sign [dB]; `nbar`: how many of Taylor's are
     *  equal; `elements`: of Dolph's array [1]. */
    explicit Taper(Weighting weighting, double sidelobe_db = -30, int nbar = 4, int elements = 64);

    double amplitude(double u) const;
    double power(double u) const { return amplitude(u) * amplitude(u); }
    /** Width of the main lobe where its power is half, both sides [u]. */
    double halfPowerWidth() const;

private:
    double taylor(double u) const;
    double dolph(double u) const;

    Weighting weighting_;
    double ratio_;  ///< Of the main lobe's amplitude to the sidelobes' [1].
    int nbar_, elements_;
};

}  // namespace insonify::acoustics

template <>
struct insonify::types::EnumNames<insonify::acoustics::Weighting> {
    static constexpr std::string_view names[] = {"uniform", "cosine", "hann",     "hamming",
                                                 "taylor",  "dolph",  "gaussian", "piston"};
};
