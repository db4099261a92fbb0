#include "components/sonar/beams/HeadScan.hpp"

#include <fmt/format.h>

#include <cmath>

#include "types/text/Hash.hpp"

namespace insonify::sonar {

void HeadConfig::check(types::Diagnostics& diagnostics) const {
    if (continuous.value_or(false)) return;
    if (left_deg <= right_deg)
        return diagnostics.push_back(
            {"left_deg",
             fmt::format("is {} deg; must be above right_deg, {} deg (positive to port)", left_deg, right_deg)});
    if (sectorDeg() > 360)
        diagnostics.push_back(
            {"left_deg", fmt::format("is {} deg from right_deg; may be at most 360 deg", sectorDeg())});
    if (step_deg > sectorDeg())
        diagnostics.push_back({"step_deg", fmt::format("is {} deg; the sector has {} deg", step_deg, sectorDeg())});
}

double findStandingDeg(const HeadConfig& config, double bearing_deg) {
    if (config.error_deg == 0) return bearing_deg;
    constexpr uint64_t seed = 0x68656164;
    constexpr long long turn = 360'000;  // in thousandths of a degree
    const auto place = static_cast<uint64_t>((std::llround(1e3 * bearing_deg) % turn + turn) % turn);
    return bearing_deg + config.error_deg * types::normal(types::hashed(seed, place, 0));
}

void ScanningSonarConfig::check(types::Diagnostics& diagnostics) const {
    beam().checkBeam(diagnostics);
    if (head.sweeps && !sonar.motion_in_ping)
        diagnostics.push_back({"head.sweeps", "is true without motion_in_ping: true, which it needs"});
}

SonarConfig ScanningSonarConfig::beam() const {
    SonarConfig one = sonar;
    one.bearings_deg = {0};
    return one;
}

HeadScan::HeadScan(const HeadConfig& config)
    : config_(config), steps_(static_cast<int64_t>(std::floor(config.sectorDeg() / config.step_deg + 1e-9))) {}

double HeadScan::bearingDeg() const {
    if (config_.turnsOn()) return config_.left_deg - std::fmod(static_cast<double>(ping_) * config_.step_deg, 360.0);
    const int64_t phase = ping_ % (2 * steps_);
    const int64_t step = phase <= steps_ ? phase : 2 * steps_ - phase;
    return config_.left_deg - static_cast<double>(step) * config_.step_deg;
}

void HeadScan::advance() { ++ping_; }

int HeadScan::pingsPerTurn() const {
    return static_cast<int>(config_.turnsOn() ? std::ceil(360 / config_.step_deg - 1e-9)
                                              : static_cast<double>(2 * steps_));
}

double stepDuration(const HeadConfig& config) {
    return config.speed_deg_per_s ? config.step_deg / *config.speed_deg_per_s : 0;
}

}  // namespace insonify::sonar
