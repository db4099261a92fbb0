#include "components/sonar/Acoustics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace insonify::sonar {
namespace {

/** f0 f^2 / (f^2 + f0^2): absorption by a relaxation at f0, without its strength; 0 where there is none. */
double relaxation(double f, double f0) { return f0 > 0 ? f0 * f * f / (f * f + f0 * f0) : 0; }

/** Pure-water term of Francois and Garrison [dB/km/kHz^2]. */
double pureWater(double t) {
    return t <= 20 ? 4.937e-4 - 2.59e-5 * t + 9.11e-7 * t * t - 1.50e-8 * t * t * t
                   : 3.964e-4 - 1.146e-5 * t + 1.45e-7 * t * t - 6.5e-10 * t * t * t;
}

struct Limit {
    const char* unit;
    double value, min, max;
};

std::string outside(std::initializer_list<Limit> limits) {
    std::string text;
    for (const Limit& limit : limits)
        if (limit.value < limit.min || limit.value > limit.max)
            text += fmt::format("{}{} {} ({} to {})", text.empty() ? "" : ", ", limit.value, limit.unit, limit.min,
                                limit.max);
    return text;
}

}  // namespace

double mackenzieSpeed(const WaterConfig& water) {
    const double t = water.temperature_celsius, s = water.salinity_psu - 35, z = water.depth;
    return 1448.96 + 4.591 * t - 5.304e-2 * t * t + 2.374e-4 * t * t * t + 1.340 * s + 1.630e-2 * z + 1.675e-7 * z * z -
           1.025e-2 * t * s - 7.139e-13 * t * z * z * z;
}

double medwinSpeed(const WaterConfig& water) {
    const double t = water.temperature_celsius, s = water.salinity_psu - 35, z = water.depth;
    return 1449.2 + 4.6 * t - 5.5e-2 * t * t + 2.9e-4 * t * t * t + (1.34 - 1e-2 * t) * s + 1.6e-2 * z;
}

double leroySpeed(const WaterConfig& water) {
    const double t = water.temperature_celsius, s = water.salinity_psu, z = water.depth;
    return 1402.5 + 5 * t - 5.44e-2 * t * t + 2.1e-4 * t * t * t + 1.33 * s - 1.23e-2 * s * t + 8.7e-5 * s * t * t +
           1.56e-2 * z + 2.55e-7 * z * z - 7.3e-12 * z * z * z - 9.5e-13 * t * z * z * z + 3e-7 * t * t * z +
           1.43e-5 * s * z;
}

double francoisGarrison(double f, const WaterConfig& water) {
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

double ainslieMccolm(double f, const WaterConfig& water) {
    const double t = water.temperature_celsius, s = water.salinity_psu, z_km = water.depth / 1000;
    const double f1 = 0.78 * std::sqrt(s / 35) * std::exp(t / 26);
    const double f2 = 42 * std::exp(t / 17);
    return (0.106 * relaxation(f, f1) * std::exp((water.ph - 8) / 0.56) +
            0.52 * (1 + t / 43) * (s / 35) * relaxation(f, f2) * std::exp(-z_km / 6) +
            4.9e-4 * f * f * std::exp(-(t / 27 + z_km / 17))) /
           1000;
}

std::string outsideValidity(AbsorptionLaw law, double f, const WaterConfig& water) {
    if (law == AbsorptionLaw::AinslieMccolm)
        return outside({{"kHz", f, 0.1, 1000},
                        {"degC", water.temperature_celsius, -6, 35},
                        {"psu", water.salinity_psu, 5, 50},
                        {"m depth", water.depth, 0, 7000},
                        {"pH", water.ph, 7.7, 8.3}});
    // Above 500 kHz pure water absorbs, and that term holds in warm and fresh water too.
    const bool pure_water = f > 500;
    return outside({{"kHz", f, 0.2, 1000},
                    {"degC", water.temperature_celsius, pure_water ? 0.0 : -2.0, pure_water ? 30.0 : 22.0},
                    {"psu", water.salinity_psu, pure_water ? 0.0 : 30.0, pure_water ? 40.0 : 35.0},
                    {"m depth", water.depth, 0, pure_water ? 10000.0 : 3500.0}});
}

double Absorption::amplitudeNepersPerMetre() const { return db_per_m * std::numbers::ln10 / 20; }

Absorption makeAbsorption(const SonarConfig& config) {
    if (!config.absorption) return {};
    const AbsorptionConfig& absorption = *config.absorption;
    if (absorption.db_per_m) return {*absorption.db_per_m};
    const auto law = absorption.law == AbsorptionLaw::AinslieMccolm ? ainslieMccolm : francoisGarrison;
    return {law(absorption.frequency_khz.value(), config.water.value())};
}

}  // namespace insonify::sonar
