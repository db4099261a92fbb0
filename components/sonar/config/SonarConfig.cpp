#include "components/sonar/config/SonarConfig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/acoustics/SoundSpeed.hpp"
#include "types/BeamArc.hpp"

namespace insonify::sonar {

ElementsConfig::Array ElementsConfig::arrayOf(double aperture_m, double wavelength) const {
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
