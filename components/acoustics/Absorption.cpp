#include "components/acoustics/Absorption.hpp"

#include <cmath>
#include <numbers>

#include "components/acoustics/SoundSpeed.hpp"

namespace insonify::acoustics {
namespace {

constexpr double decibels_per_neper = 20 / std::numbers::ln10;
constexpr double bar_per_atmosphere = 1.01325;

/** Returns f0 f^2 / (f^2 + f0^2): absorption by a relaxation at f0, without its strength; 0 for f0 = 0. */
double relaxation(double f, double f0) { return f0 > 0 ? f0 * f * f / (f * f + f0 * f0) : 0; }

/** Pure-water term of Francois and Garrison [dB/km/kHz^2]. */
double pureWater(double t) {
    return t <= 20 ? 4.937e-4 - 2.59e-5 * t + 9.11e-7 * t * t - 1.50e-8 * t * t * t
                   : 3.964e-4 - 1.146e-5 * t + 1.45e-7 * t * t - 6.5e-10 * t * t * t;
}

}  // namespace

double francoisGarrison(double f, const Water& water) {
    const double t = water.temperature_celsius, s = water.salinity_psu, z = water.depth;
    const double c = 1412 + 3.21 * t + 1.19 * s + 0.0167 * z;

    // Boric acid.
    const double a1 = 8.86 / c * std::pow(10, 0.78 * water.ph - 5);
    const double f1 = 2.8 * std::sqrt(s / 35) * std::pow(10, 4 - 1245 / (t + 273));

    // Magnesium sulphate.
    const double a2 = 21.44 * s / c * (1 + 0.025 * t);
    const double p2 = 1 - 1.37e-4 * z + 6.2e-9 * z * z;
    const double f2 = 8.17 * std::pow(10, 8 - 1990 / (t + 273)) / (1 + 0.0018 * (s - 35));

    const double p3 = 1 - 3.83e-5 * z + 4.9e-10 * z * z;
    return (a1 * relaxation(f, f1) + a2 * p2 * relaxation(f, f2) + pureWater(t) * p3 * f * f) / 1000;
}

double ainslieMccolm(double f, const Water& water) {
    const double t = water.temperature_celsius, s = water.salinity_psu, z_km = water.depth / 1000;
    const double f1 = 0.78 * std::sqrt(s / 35) * std::exp(t / 26);
    const double f2 = 42 * std::exp(t / 17);
    return (0.106 * relaxation(f, f1) * std::exp((water.ph - 8) / 0.56) +
            0.52 * (1 + t / 43) * (s / 35) * relaxation(f, f2) * std::exp(-z_km / 6) +
            4.9e-4 * f * f * std::exp(-(t / 27 + z_km / 17))) /
           1000;
}

double fisherSimmons(double frequency_khz, const Water& water) {
    const double f = 1000 * frequency_khz, t = water.temperature_celsius, kelvin = t + 273.1;
    const double p = gaugePressureBar(water.depth, water.latitude_deg) / bar_per_atmosphere;

    // Boric acid.
    const double a1 = 1.03e-8 + 2.36e-10 * t - 5.22e-12 * t * t;
    const double f1 = 1.32e3 * kelvin * std::exp(-1700 / kelvin);

    // Magnesium sulphate.
    const double a2 = 5.62e-8 + 7.52e-10 * t;
    const double p2 = 1 - 10.3e-4 * p + 3.7e-7 * p * p;
    const double f2 = 1.55e7 * kelvin * std::exp(-3052 / kelvin);

    const double a3 = (55.9 - 2.37 * t + 4.77e-2 * t * t - 3.48e-4 * t * t * t) * 1e-15;
    const double p3 = 1 - 3.84e-4 * p + 7.57e-8 * p * p;
    return decibels_per_neper * (a1 * relaxation(f, f1) + a2 * p2 * relaxation(f, f2) + a3 * p3 * f * f);
}

double thorp(double frequency_khz) {
    const double f2 = frequency_khz * frequency_khz;
    return (3.3e-3 + 0.11 * f2 / (1 + f2) + 44 * f2 / (4100 + f2) + 3e-4 * f2) / 1000;
}

double absorptionDbPerM(AbsorptionLaw law, double frequency_khz, const Water& water) {
    switch (law) {
        case AbsorptionLaw::FrancoisGarrison: return francoisGarrison(frequency_khz, water);
        case AbsorptionLaw::AinslieMccolm: return ainslieMccolm(frequency_khz, water);
        case AbsorptionLaw::FisherSimmons: return fisherSimmons(frequency_khz, water);
        case AbsorptionLaw::Thorp: return thorp(frequency_khz);
    }
    return francoisGarrison(frequency_khz, water);
}

std::string outsideValidity(AbsorptionLaw law, double f, const Water& water) {
    const double t = water.temperature_celsius, s = water.salinity_psu, z = water.depth;
    if (law == AbsorptionLaw::AinslieMccolm)
        return outside({{"kHz", f, 0.1, 1000},
                        {"degC", t, -6, 35},
                        {"psu", s, 5, 50},
                        {"m depth", z, 0, 7000},
                        {"pH", water.ph, 7.7, 8.3}});
    if (law == AbsorptionLaw::FisherSimmons)
        return outside({{"kHz", f, 10, 400},
                        {"degC", t, 0, 30},
                        {"psu", s, 34, 36},
                        {"m depth", z, 0, 5000},
                        {"pH", water.ph, 7.9, 8.1}});
    if (law == AbsorptionLaw::Thorp) return outside({{"kHz", f, 0.1, 50}, {"degC", t, 2, 6}, {"m depth", z, 0, 2000}});
    // Above 500 kHz the pure-water term dominates. It is valid in warm and fresh water too.
    const bool pure_water = f > 500;
    return outside({{"kHz", f, 0.2, 1000},
                    {"degC", t, pure_water ? 0.0 : -2.0, pure_water ? 30.0 : 22.0},
                    {"psu", s, pure_water ? 0.0 : 30.0, pure_water ? 40.0 : 35.0},
                    {"m depth", z, 0, pure_water ? 10000.0 : 3500.0}});
}

double Absorption::amplitudeNepersPerMetre() const { return db_per_m / decibels_per_neper; }

}  // namespace insonify::acoustics
