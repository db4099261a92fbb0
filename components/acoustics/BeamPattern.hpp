#pragma once
#include <functional>
#include <optional>
#include <string>

#include "components/acoustics/Curve.hpp"
#include "components/acoustics/Taper.hpp"

namespace insonify::acoustics {

/** How one array hears, or sends, across one of its axes: a weighted aperture, or a measured table. */
struct BeamLaw {
    std::optional<Weighting> weighting;
    std::optional<double> width_deg, aperture_m, sidelobe_db;
    std::optional<int> nbar;
    std::string file;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"weighting", "", "of the aperture; absent: uniform (Harris 1978, Taylor 1955, Dolph 1946)"},
              self.weighting);
        visit(Field{"width_deg", "deg", "one way, where the power is half", 0.01, 180}, self.width_deg);
        visit(Field{"aperture_m", "m", "instead: length of the array, or diameter of a piston; needs frequency_khz",
                    1e-4, 100},
              self.aperture_m);
        visit(Field{"sidelobe_db", "dB", "of taylor and dolph: highest sidelobe below the axis, either sign; else -30",
                    -100, 100},
              self.sidelobe_db);
        visit(Field{"nbar", "1", "of taylor: how many sidelobes are as high; else 4", 2, 100}, self.nbar);
        visit(Field{"file", "", "instead: CSV file with angle_deg,level_db"}, self.file);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** A power pattern about its axis, one way, 1 on the axis: ACOUSTICS.md 5.9. */
class BeamPattern {
public:
    /** `wavelength` [m] is asked for by an aperture.
     *  @throws types::ConfigError where the law's file is none, or there is no wavelength. */
    explicit BeamPattern(const BeamLaw& law, std::optional<double> wavelength = {});

    /** At an angle off the axis [rad]; an aperture hears nothing behind itself. */
    double power(double angle) const { return power(angle, 0); }
    /** At an angle of an array that is steered to `axis`, both from its normal [rad]. */
    double power(double angle, double axis) const;
    /** Of the field there, of which the power is the square: sidelobes of an aperture change sign from one to the next;
     *  a measured table tells no sign, so it has none. */
    double amplitude(double angle, double axis = 0) const;
    /** Length of the aperture [wavelengths]; 0 for a measured table. */
    double aperture() const { return aperture_; }
    /** Its far field, where it is no measured table. */
    const Taper& taper() const { return taper_; }

private:
    void scaleTo(const BeamLaw& law, std::optional<double> wavelength);

    Taper taper_;
    double aperture_ = 0;
    Curve measured_;  ///< Level over angle [dB, deg], 0 on the axis; empty for an aperture.
};

/** What a data sheet tells of a pattern. Angles from the axis [rad]. */
struct CutShape {
    double width_3db = 0;                    ///< Between the two sides.
    std::optional<double> first_null;        ///< First minimum, of the nearer side.
    std::optional<double> peak_sidelobe_db;  ///< Highest level beyond the first minimum, relative to the axis.
};

/** Of a power pattern over angles from -pi/2 to pi/2 [rad], 1 at 0. */
CutShape shapeOf(const std::function<double(double)>& power);
/** Its integral over the sine of the angle, from -1 to 1 [1]. */
double integralOverSine(const std::function<double(double)>& power);

}  // namespace insonify::acoustics
