#include "components/sonar/config/SonarConfig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/acoustics/SoundSpeed.hpp"
#include "types/geometry/Angle.hpp"
#include "types/geometry/BeamArc.hpp"
#include "types/text/Hash.hpp"

namespace insonify::sonar {
namespace {

/** Streams of independent random numbers of one device. */
enum ErrorStream : uint64_t { element_errors = 1, element_failures, beam_errors, beam_failures };

uint64_t errorSeed(uint32_t seed, ErrorStream stream) { return types::hashed(seed, 0x6d706572, stream); }

/** Two independent variates of N(0, 1) (Box and Muller 1958). */
std::complex<double> normalPair(uint64_t seed, size_t place) {
    const uint64_t word = types::hashed(seed, place, 0);
    return std::polar(std::sqrt(-2 * std::log(types::unit(word >> 32))),
                      2 * std::numbers::pi * types::unit(word & 0xffffffff));
}

/** Returns whether the element or beam `place` has failed: at random, or because the list contains it. */
bool hasFailed(uint64_t seed, size_t place, double share, const std::vector<uint32_t>& list) {
    return types::unit(types::hashed(seed, place, 1) >> 32) < share ||
           std::ranges::find(list, static_cast<uint32_t>(place)) != list.end();
}

}  // namespace

std::vector<std::complex<double>> ImperfectionsConfig::elementFactors(size_t count) const {
    std::vector<std::complex<double>> factors;
    for (size_t m = 0; m < count; ++m) {
        const std::complex<double> errors = normalPair(errorSeed(seed, element_errors), m);
        const bool failed = hasFailed(errorSeed(seed, element_failures), m, dead_element_share, dead_elements);
        factors.push_back(failed ? 0.0
                                 : std::polar(std::pow(10, errors.real() * gain_error_db / 20),
                                              errors.imag() * types::radians(phase_error_deg)));
    }
    return factors;
}

std::vector<float> ImperfectionsConfig::beamFactors(size_t count) const {
    std::vector<float> factors;
    for (size_t k = 0; k < count; ++k) {
        const double error = normalPair(errorSeed(seed, beam_errors), k).real() * beam_gain_error_db;
        const bool failed = hasFailed(errorSeed(seed, beam_failures), k, dead_beam_share, dead_beams);
        factors.push_back(failed ? 0.0f : static_cast<float>(std::pow(10, error / 10)));
    }
    return factors;
}

ElementsConfig::Array ElementsConfig::makeArray(double aperture_m, double wavelength) const {
    const double wanted = spacing_m.value_or(count ? aperture_m / *count : 0.5 * wavelength);
    const auto all = count ? static_cast<size_t>(*count) : static_cast<size_t>(std::lround(aperture_m / wanted));
    return {all, spacing_m.value_or(aperture_m / std::max(1.0, static_cast<double>(all)))};
}

double SonarConfig::bearingDeg(int k) const {
    return bearings_deg.empty() ? fieldOfViewDeg() * ((k + 0.5) / beam_count - 0.5)
                                : bearings_deg[static_cast<size_t>(k)];
}

double SonarConfig::coverageDeg() const {
    if (bearings_deg.empty()) return fieldOfViewDeg();
    const types::ArcOrder arc = types::alongArc(bearings_deg, 360);
    const double first = bearings_deg[arc.order.front()], last = bearings_deg[arc.order.back()];
    return std::min(last - first + (arc.turned > 0 ? 360 : 0) + beamWidthDeg(), 360.0);
}

std::optional<double> SonarConfig::targetError() const {
    constexpr double default_target = 0.05;
    if (quality.target_error) return quality.target_error;
    if (published || quality.isGiven() || quality.budget_ms) return {};
    return default_target;
}

std::optional<double> SonarConfig::maxSamples() const {
    constexpr double default_max = 400'000;
    if (quality.max_samples) return *quality.max_samples;
    if (quality.target_error || !targetError()) return {};
    return default_max;
}

double SonarConfig::speedOfSound() const {
    return speed_of_sound.value_or(water ? acoustics::soundSpeed(*water) : 1500);
}

SonarConfig SonarConfig::fan() const {
    SonarConfig fan = *this;
    if (!bearings_deg.empty() || !beam_width_deg) return fan;
    if (field_of_view_deg) {
        for (int k = 0; k < beam_count; ++k) fan.bearings_deg.push_back(bearingDeg(k));
        return fan;
    }
    const bool total = beam_width_convention == BeamWidthConvention::TotalFov;
    fan.field_of_view_deg = total ? *beam_width_deg : *beam_width_deg * beam_count;
    fan.beam_width_deg.reset();
    return fan;
}

}  // namespace insonify::sonar
