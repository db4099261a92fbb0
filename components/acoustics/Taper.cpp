#include "components/acoustics/Taper.hpp"

#include <cmath>
#include <numbers>

namespace insonify::acoustics {
namespace {

using std::numbers::pi;

double sinc(double u) { return u == 0 ? 1 : std::sin(pi * u) / (pi * u); }

/** Moves u away from places where numerator and denominator are both 0: multiples of 1/2. */
double betweenPoles(double u) {
    constexpr double near = 1e-7;
    const double off = std::remainder(u, 0.5);
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

}  // namespace

Taper::Taper(Weighting weighting, double sidelobe_db, int nbar, int elements)
    : weighting_(weighting), ratio_(std::pow(10, std::abs(sidelobe_db) / 20)), nbar_(nbar), elements_(elements) {}

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
    const double a = std::acosh(ratio_) / pi;
    const double dilation = nbar_ / std::sqrt(a * a + (nbar_ - 0.5) * (nbar_ - 0.5));
    double product = sinc(u);
    for (int n = 1; n < nbar_; ++n) {
        const double zero = dilation * std::sqrt(a * a + (n - 0.5) * (n - 0.5));
        product *= (1 - u * u / (zero * zero)) / (1 - u * u / (n * n));
    }
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

}  // namespace insonify::acoustics
