#include "components/acoustics/BeamPattern.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "types/text/ConfigError.hpp"

namespace insonify::acoustics {
namespace {

using std::numbers::pi;

double sinc(double u) { return u == 0 ? 1 : std::sin(pi * u) / (pi * u); }

/** Moves u away from places where numerator and denominator are both 0: multiples of 1/2. */
double betweenPoles(double u) {
    constexpr double near = 1e-7;
    const double off = u - 0.5 * std::nearbyint(2 * u);  // std::remainder(u, 0.5), which is slow
    return std::abs(u) > 0.25 && std::abs(off) < near ? u - off + near : u;
}

double hann(double u) { return sinc(u) / (1 - u * u); }

double hamming(double u) {
    constexpr double mean = 0.54, wave = 0.46;
    return sinc(u) + wave / (2 * mean) * (sinc(u - 1) + sinc(u + 1));
}

double cosine(double u) { return std::cos(pi * u) / (1 - 4 * u * u); }

double piston(double u) {
    const double x = pi * std::abs(u);
    return x < 1e-6 ? 1 : 2 * std::cyl_bessel_j(1.0, x) / x;
}

/** A Gaussian whose power is half at u = 1/2. */
double gaussian(double u) { return std::exp2(-2 * u * u); }

/** Chebyshev's polynomial of degree m. */
double chebyshev(int m, double x) {
    if (std::abs(x) <= 1) return std::cos(m * std::acos(x));
    const double size = std::cosh(m * std::acosh(std::abs(x)));
    return x < 0 && m % 2 ? -size : size;
}

constexpr long places_per_unit = 16;

using std::numbers::pi;

constexpr double default_sidelobe_db = -30;
constexpr int default_nbar = 4;

Weighting getWeighting(const BeamLaw& law) { return law.weighting.value_or(Weighting::Uniform); }

Taper computeTaper(const BeamLaw& law, int elements) {
    return Taper(getWeighting(law), law.sidelobe_db.value_or(default_sidelobe_db), law.nbar.value_or(default_nbar),
                 elements);
}

/** Returns the number of elements of half a wavelength each. */
int countElements(double aperture) { return std::max(2, static_cast<int>(std::lround(2 * aperture))); }

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

Side computeSide(const std::function<double(double)>& power) {
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

Taper::Taper(Weighting weighting, double sidelobe_db, int nbar, int elements)
    : weighting_(weighting), ratio_(std::pow(10, std::abs(sidelobe_db) / 20)), elements_(elements) {
    if (weighting != Weighting::Taylor) return;
    const double a = std::acosh(ratio_) / pi;
    const double dilation = nbar / std::sqrt(a * a + (nbar - 0.5) * (nbar - 0.5));
    for (int n = 1; n < nbar; ++n) {
        const double zero = dilation * std::sqrt(a * a + (n - 0.5) * (n - 0.5));
        zeros_.push_back(zero * zero);
    }
}

double Taper::amplitude(double u) const {
    if (u == 0) return 1;
    switch (weighting_) {
        case Weighting::Uniform: return sinc(u);
        case Weighting::Cosine: return cosine(betweenPoles(u));
        case Weighting::Hann: return hann(betweenPoles(u));
        case Weighting::Hamming: return hamming(u);
        case Weighting::Taylor: return taylor(betweenPoles(u));
        case Weighting::Dolph: return dolph(u);
        case Weighting::Gaussian: return gaussian(u);
        case Weighting::Piston: return piston(u);
    }
    return sinc(u);
}

/** Taylor 1955: the first nbar - 1 zeros of sinc moved to where Dolph's are. */
double Taper::taylor(double u) const {
    double product = sinc(u);
    for (size_t n = 1; n <= zeros_.size(); ++n)
        product *= (1 - u * u / zeros_[n - 1]) / (1 - u * u / static_cast<double>(n * n));
    return product;
}

/** Dolph 1946, with elements at a spacing of L / elements. */
double Taper::dolph(double u) const {
    const int degree = elements_ - 1;
    return chebyshev(degree, std::cosh(std::acosh(ratio_) / degree) * std::cos(pi * u / elements_)) / ratio_;
}

double Taper::halfPowerWidth() const {
    constexpr double step = 0.01;
    double low = 0, high = step;
    for (; power(high) > 0.5; high += step) low = high;
    for (int i = 0; i < 60; ++i) (power((low + high) / 2) > 0.5 ? low : high) = (low + high) / 2;
    return low + high;
}

std::vector<double> elementWeights(size_t count, double aperture, const Taper& taper) {
    std::vector<double> weights;
    const auto terms = static_cast<size_t>(std::ceil(std::min(0.5 * static_cast<double>(count), aperture)));
    const auto size = static_cast<double>(count);
    std::vector<double> amplitudes;
    for (size_t n = 0; n < terms; ++n) amplitudes.push_back(taper.amplitude(static_cast<double>(n)));
    for (size_t m = 0; m < count; ++m) {
        const double place = (static_cast<double>(m) + 0.5) / size - 0.5;
        double weight = 1;
        for (size_t n = 1; n < terms; ++n)
            weight += 2 * amplitudes[n] * std::cos(2 * std::numbers::pi * static_cast<double>(n) * place);
        weights.push_back(weight / size);
    }
    return weights;
}

double elementPlace(size_t element, size_t count) {
    return (static_cast<double>(element) + 0.5) / static_cast<double>(count) - 0.5;
}

ElementField::ElementField(std::span<const std::complex<double>> parts)
    : period_(static_cast<long>(parts.size()) * places_per_unit), sign_(parts.size() % 2 == 0 ? -1 : 1) {
    table_.resize(static_cast<size_t>(period_));
    constexpr size_t together = 4;  // chains of products, each of which waits for its last
    for (size_t first = 0; first < parts.size(); first += together) {
        const size_t count = std::min(together, parts.size() - first);
        std::array<double, together> turns{};
        std::array<std::complex<double>, together> step{}, turned{};
        for (size_t i = 0; i < count; ++i) {
            turns[i] = elementPlace(first + i, parts.size()) / places_per_unit;
            step[i] = std::polar(1.0, 2 * std::numbers::pi * turns[i]);
        }
        for (size_t place = 0; place < table_.size(); ++place) {
            if (place % 256 == 0)  // so that rounding does not add up
                for (size_t i = 0; i < count; ++i)
                    turned[i] = parts[first + i] *
                                std::polar(1.0, 2 * std::numbers::pi * turns[i] * static_cast<double>(place));
            for (size_t i = 0; i < together; ++i) {
                table_[place] += turned[i];
                turned[i] = {turned[i].real() * step[i].real() - turned[i].imag() * step[i].imag(),
                             turned[i].real() * step[i].imag() + turned[i].imag() * step[i].real()};
            }
        }
    }
}

std::complex<double> ElementField::at(double u) const {
    if (table_.empty()) return 0;
    const double place = u * places_per_unit, low = std::floor(place), t = place - low;
    const long first = static_cast<long>(low) - 1, rest = first % period_;
    long within = rest < 0 ? rest + period_ : rest;
    double sign = (first - within) / period_ % 2 != 0 ? sign_ : 1;
    // Lagrange's cubic through the two places to either side.
    const double weights[] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
                              (t + 1) * t * (t - 1) / 6};
    std::complex<double> sum;
    for (const double weight : weights) {
        sum += table_[static_cast<size_t>(within)] * (sign * weight);
        if (++within == period_) within = 0, sign *= sign_;
    }
    return sum;
}

void BeamLaw::check(types::Diagnostics& diagnostics) const {
    const Weighting chosen = getWeighting(*this);
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

BeamPattern::BeamPattern(const BeamLaw& law, std::optional<double> wavelength) : taper_(computeTaper(law, 64)) {
    if (law.file.empty())
        scaleTo(law, wavelength);
    else
        measured_ = aboutTheAxis(readCurve(law.file, {"angle_deg", -180, 180}, {"level_db", -1000, 1000}), law.file);
}

void BeamPattern::scaleTo(const BeamLaw& law, std::optional<double> wavelength) {
    if (law.aperture_m) {
        if (!wavelength) throw types::ConfigError("", "aperture_m", "is given without frequency_khz, which it needs");
        aperture_ = *law.aperture_m / *wavelength;
        taper_ = computeTaper(law, countElements(aperture_));
        return;
    }
    const double sine = 2 * std::sin(law.width_deg.value() * pi / 360);
    for (int i = 0; i < 4; ++i) {  // the width of Dolph's beams depends a little on the number of elements
        aperture_ = taper_.halfPowerWidth() / sine;
        taper_ = computeTaper(law, countElements(aperture_));
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

CutShape getShape(const std::function<double(double)>& power) {
    const Side right = computeSide(power), left = computeSide([&](double angle) { return power(-angle); });
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
