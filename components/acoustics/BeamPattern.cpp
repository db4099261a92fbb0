#include "components/acoustics/BeamPattern.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "types/ConfigError.hpp"

namespace insonify::acoustics {
namespace {

using std::numbers::pi;

constexpr double default_sidelobe_db = -30;
constexpr int default_nbar = 4;

Weighting weightingOf(const BeamLaw& law) { return law.weighting.value_or(Weighting::Uniform); }

Taper taperOf(const BeamLaw& law, int elements) {
    return Taper(weightingOf(law), law.sidelobe_db.value_or(default_sidelobe_db), law.nbar.value_or(default_nbar),
                 elements);
}

/** Returns the number of elements of half a wavelength each. */
int elementsOf(double aperture) { return std::max(2, static_cast<int>(std::lround(2 * aperture))); }

/** Returns the levels relative to the level on the axis. Mirrors a curve that was measured on one side only. */
Curve aboutTheAxis(Curve curve, const std::string& file) {
    if (curve.x.front() > 0 || curve.x.back() < 0)
        throw types::ConfigError(file, "angle_deg", "does not include 0; the pattern is relative to its axis");
    const double axis_db = curve.at(0);
    for (double& level : curve.y) level -= axis_db;
    if (curve.x.front() < 0) return curve;
    Curve both;
    for (size_t i = curve.x.size(); i-- > 1;) {
        both.x.push_back(-curve.x[i]);
        both.y.push_back(curve.y[i]);
    }
    both.x.insert(both.x.end(), curve.x.begin(), curve.x.end());
    both.y.insert(both.y.end(), curve.y.begin(), curve.y.end());
    return both;
}

/** The shape of one side of a pattern, angles in [rad]. */
struct Side {
    double half_width = pi / 2;
    std::optional<double> first_null;
    double sidelobe = 0;
};

/** Returns the place of the minimum of a smooth function between two places, by golden section. */
double extremeBetween(const std::function<double(double)>& f, double low, double high) {
    const double golden = (std::sqrt(5.0) - 1) / 2;
    for (int i = 0; i < 60; ++i) {
        const double left = high - golden * (high - low), right = low + golden * (high - low);
        (f(left) < f(right) ? high : low) = f(left) < f(right) ? right : left;
    }
    return (low + high) / 2;
}

double halfPowerAngle(const std::function<double(double)>& power) {
    double low = 0, high = 1e-6;
    for (; high < pi / 2 && power(high) > 0.5; high *= 1.01) low = high;
    if (high >= pi / 2) return pi / 2;
    for (int i = 0; i < 60; ++i) (power((low + high) / 2) > 0.5 ? low : high) = (low + high) / 2;
    return low;
}

Side sideOf(const std::function<double(double)>& power) {
    constexpr int steps_per_half_width = 40;
    Side side;
    side.half_width = halfPowerAngle(power);
    const double step = side.half_width / steps_per_half_width;
    double before = power(side.half_width), here = power(side.half_width + step);
    for (double angle = side.half_width + step; angle + step <= pi / 2; angle += step) {
        const double after = power(angle + step);
        if (!side.first_null && here <= before && here < after)
            side.first_null = extremeBetween(power, angle - step, angle + step);
        if (side.first_null && here >= before && here > after && here > 0.8 * side.sidelobe) {
            const double top = extremeBetween([&](double a) { return -power(a); }, angle - step, angle + step);
            side.sidelobe = std::max(side.sidelobe, power(top));
        }
        before = here;
        here = after;
    }
    return side;
}

}  // namespace

void BeamLaw::check(types::Diagnostics& diagnostics) const {
    const Weighting chosen = weightingOf(*this);
    const int given = (width_deg ? 1 : 0) + (aperture_m ? 1 : 0) + (file.empty() ? 0 : 1);
    if (given == 0) diagnostics.push_back({"", "has no width; give width_deg, aperture_m or file"});
    if (given > 1) diagnostics.push_back({"", "has several widths; give one of width_deg, aperture_m and file"});
    if (!file.empty() && (weighting || sidelobe_db || nbar))
        diagnostics.push_back({"file", "is given together with a weighting; give one of the two"});
    if (chosen == Weighting::Gaussian && aperture_m)
        diagnostics.push_back({"aperture_m", "is given for a gaussian, which has no edge; give width_deg"});
    const bool has_depth = chosen == Weighting::Taylor || chosen == Weighting::Dolph;
    if (sidelobe_db && !has_depth) diagnostics.push_back({"sidelobe_db", "is given; only taylor and dolph take one"});
    if (sidelobe_db && std::abs(*sidelobe_db) < 13.3)
        diagnostics.push_back({"sidelobe_db", "is nearer to 0 than -13.3, which a uniform aperture has"});
    if (nbar && chosen != Weighting::Taylor) diagnostics.push_back({"nbar", "is given; only taylor takes it"});
}

BeamPattern::BeamPattern(const BeamLaw& law, std::optional<double> wavelength) : taper_(taperOf(law, 64)) {
    if (law.file.empty())
        scaleTo(law, wavelength);
    else
        measured_ = aboutTheAxis(readCurve(law.file, {"angle_deg", -180, 180}, {"level_db", -1000, 1000}), law.file);
}

void BeamPattern::scaleTo(const BeamLaw& law, std::optional<double> wavelength) {
    if (law.aperture_m) {
        if (!wavelength) throw types::ConfigError("", "aperture_m", "is given without frequency_khz, which it needs");
        aperture_ = *law.aperture_m / *wavelength;
        taper_ = taperOf(law, elementsOf(aperture_));
        return;
    }
    const double sine = 2 * std::sin(law.width_deg.value() * pi / 360);
    for (int i = 0; i < 4; ++i) {  // the width of Dolph's beams depends a little on the number of elements
        aperture_ = taper_.halfPowerWidth() / sine;
        taper_ = taperOf(law, elementsOf(aperture_));
    }
    aperture_ = taper_.halfPowerWidth() / sine;
}

double BeamPattern::power(double angle, double axis) const {
    if (measured_.x.empty()) {
        const double field = amplitude(angle, axis);
        return field * field;
    }
    const double degrees = (angle - axis) * 180 / pi;
    if (degrees < measured_.x.front() || degrees > measured_.x.back()) return 0;
    return std::pow(10, measured_.at(degrees) / 10);
}

double BeamPattern::amplitude(double angle, double axis) const {
    if (!measured_.x.empty()) return std::sqrt(power(angle, axis));
    if (std::abs(angle) > pi / 2) return 0;
    return taper_.amplitude(aperture_ * (std::sin(angle) - std::sin(axis)));
}

CutShape shapeOf(const std::function<double(double)>& power) {
    const Side right = sideOf(power), left = sideOf([&](double angle) { return power(-angle); });
    CutShape shape{right.half_width + left.half_width, right.first_null, {}};
    if (left.first_null) shape.first_null = std::min(*left.first_null, right.first_null.value_or(*left.first_null));
    const double highest = std::max(left.sidelobe, right.sidelobe);
    if (highest > 0) shape.peak_sidelobe_db = 10 * std::log10(highest);
    return shape;
}

double integralOverSine(const std::function<double(double)>& power) {
    constexpr int cells = 200000;
    double sum = 0;
    for (int i = 0; i < cells; ++i) sum += power(std::asin(-1 + (2 * i + 1.0) / cells));
    return 2 * sum / cells;
}

}  // namespace insonify::acoustics
