#pragma once
#include <functional>
#include <optional>
#include <string>

#include "components/acoustics/Curve.hpp"
#include "components/acoustics/Taper.hpp"

namespace insonify::acoustics {

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
CutShape shapeOf(const std::function<double(double)>& power);
/** Returns the integral of a power pattern over the sine of the angle, from -1 to 1 [1]. */
double integralOverSine(const std::function<double(double)>& power);

}  // namespace insonify::acoustics
