#pragma once
#include <complex>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/acoustics/Curve.hpp"
#include "types/text/Describe.hpp"

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
    int elements_;
    std::vector<double> zeros_;  ///< Squares of Taylor's moved zeros [u^2].
};

/** Returns the weights of adjacent equal elements whose far field is `taper`. They are its Fourier series with the far
 *  field at whole u as coefficients (Woodward 1946), up to what the elements resolve and to directions that exist. They
 *  sum up to 1. `aperture`: length of the array [wavelengths]. */
std::vector<double> elementWeights(size_t count, double aperture, const Taper& taper);

/** Returns the place of an element's middle, from -1/2 to 1/2 of the array's length [1]. */
double elementPlace(size_t element, size_t count);

/** The far field of elements, sum over m of part_m exp(2 pi i u place_m), from a table over u. The table has 16 values
 *  per unit, interpolated by cubics: the error is at most 1e-4 of the sum of the magnitudes of the parts. */
class ElementField {
public:
    /** Makes a field without elements: 0 everywhere. */
    ElementField() = default;
    explicit ElementField(std::span<const std::complex<double>> parts);

    bool empty() const { return table_.empty(); }
    /** Returns the field at u = length / wavelength (sin(angle) - sin(axis)), any number [1]. */
    std::complex<double> at(double u) const;

private:
    long period_ = 0;  ///< Entries of the table after which the field, or its negative, repeats.
    double sign_ = 1;  ///< Factor of the field from one period to the next, 1 or -1.
    std::vector<std::complex<double>> table_;
};

/** The configuration of an array's pattern across one of its axes: a weighted aperture, or a measured table. */
struct BeamLaw {
    std::optional<Weighting> weighting;
    std::optional<double> width_deg, aperture_m, sidelobe_db;
    std::optional<int> nbar;
    std::string file;

    static void describe(auto& self, auto& visit) {
        visit({"weighting", "", "of the aperture; absent: uniform (Harris 1978, Taylor 1955, Dolph 1946)"},
              self.weighting);
        visit({"width_deg", "deg", "one way, where the power is half", 0.01, 180}, self.width_deg);
        visit({"aperture_m", "m", "instead: length of the array, or diameter of a piston; needs frequency_khz", 1e-4,
               100},
              self.aperture_m);
        visit({"sidelobe_db", "dB", "of taylor and dolph: highest sidelobe below the axis, either sign; else -30", -100,
               100},
              self.sidelobe_db);
        visit({"nbar", "1", "of taylor: number of sidelobes of equal height; else 4", 2, 100}, self.nbar);
        visit({"file", "", "instead: CSV file with angle_deg,level_db"}, self.file);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** A power pattern about its axis, one way, 1 on the axis: ACOUSTICS.md 5.9. */
class BeamPattern {
public:
    /** @param wavelength [m], needed by a law with `aperture_m`
     *  @throws types::ConfigError when the law's file is invalid, or the wavelength is missing. */
    explicit BeamPattern(const BeamLaw& law, std::optional<double> wavelength = {});

    /** Returns the power at an angle off the axis [rad]. Behind an aperture the power is 0. */
    double power(double angle) const { return power(angle, 0); }
    /** Returns the power at an angle when the beam is steered to `axis`, both from the array's normal [rad]. */
    double power(double angle, double axis) const;
    /** Returns the amplitude of the field, whose square is the power. Successive sidelobes of an aperture alternate in
     *  sign; the amplitude of a measured table is never negative. */
    double amplitude(double angle, double axis = 0) const;
    /** Returns the length of the aperture [wavelengths]; 0 for a measured table. */
    double aperture() const { return aperture_; }
    /** Returns the far field of the aperture; meaningless for a measured table. */
    const Taper& taper() const { return taper_; }

private:
    void scaleTo(const BeamLaw& law, std::optional<double> wavelength);

    Taper taper_;
    double aperture_ = 0;
    Curve measured_;  ///< Level over angle [dB, deg], 0 on the axis; empty for an aperture.
};

/** The figures of a pattern that data sheets state. Angles are from the axis [rad]. */
struct CutShape {
    double width_3db = 0;                    ///< Between the two sides.
    std::optional<double> first_null;        ///< First minimum, on the nearer side.
    std::optional<double> peak_sidelobe_db;  ///< Highest level beyond the first minimum, relative to the axis.
};

/** Returns the shape of a power pattern over angles from -pi/2 to pi/2 [rad]; the power at 0 must be 1. */
CutShape getShape(const std::function<double(double)>& power);
/** Returns the integral of a power pattern over the sine of the angle, from -1 to 1 [1]. */
double integralOverSine(const std::function<double(double)>& power);

}  // namespace insonify::acoustics

template <>
struct insonify::types::EnumNames<insonify::acoustics::Weighting> {
    static constexpr std::string_view names[] = {"uniform", "cosine", "hann",     "hamming",
                                                 "taylor",  "dolph",  "gaussian", "piston"};
};
