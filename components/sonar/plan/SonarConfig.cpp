#include "components/sonar/plan/SonarConfig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/acoustics/SoundSpeed.hpp"
#include "types/BeamArc.hpp"

namespace insonify::sonar {

void AbsorptionConfig::check(types::Diagnostics& diagnostics) const {
    if (db_per_m && frequency_khz)
        diagnostics.push_back({"db_per_m", "is given with frequency_khz; give one of the two"});
}

ElementsConfig::Array ElementsConfig::arrayOf(double aperture_m, double wavelength) const {
    const double wanted = spacing_m.value_or(count ? aperture_m / *count : 0.5 * wavelength);
    const auto all = count ? static_cast<size_t>(*count) : static_cast<size_t>(std::lround(aperture_m / wanted));
    return {all, spacing_m.value_or(aperture_m / std::max(1.0, static_cast<double>(all)))};
}

void BeamPatternConfig::check(types::Diagnostics& diagnostics) const {
    if (!hasAzimuth() && !hasElevation())
        diagnostics.push_back({"", "has no law; give azimuth or elevation of transmit or receive"});
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

std::string SonarConfig::needsRays() const {
    if (isCoherent()) return "speckle";
    if (tracesPaths()) return "multipath";
    if (motion_in_ping) return "motion_in_ping";
    return crosstalk && crosstalk->echoes ? "crosstalk.echoes" : "";
}

std::optional<double> SonarConfig::maxSamples() const {
    constexpr double default_max = 400'000;
    if (quality.max_samples) return *quality.max_samples;
    if (quality.target_error || !targetError()) return {};
    return default_max;
}

std::optional<double> SonarConfig::absorbedKhz() const {
    if (!absorption || absorption->db_per_m) return {};
    return absorption->frequency_khz ? absorption->frequency_khz : frequency_khz;
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

void QualityConfig::check(types::Diagnostics& diagnostics) const {
    const char* const choices =
        "is given with another choice; give rows and columns_per_beam, or target_error and max_samples, or budget_ms";
    const auto refuse = [&](const char* name, bool given, bool other) {
        if (given && (isGiven() || other)) diagnostics.push_back({name, choices});
    };
    refuse("target_error", target_error.has_value(), budget_ms.has_value());
    refuse("max_samples", max_samples.has_value(), budget_ms.has_value());
    refuse("budget_ms", budget_ms.has_value(), false);
}

}  // namespace insonify::sonar
