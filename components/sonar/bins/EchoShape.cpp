#include "components/sonar/bins/EchoShape.hpp"

#include <algorithm>
#include <cmath>

#include "components/sonar/beams/BinGrid.hpp"

namespace insonify::sonar {
namespace {

/** Steps of the table over the width of h [1]. */
constexpr double steps_per_width = 256;

}  // namespace

EchoShape::EchoShape(const acoustics::Pulse& pulse) : reach_(pulse.extent(RangeResponse::floor_db)) {
    if (!pulse.peakSidelobeDb()) {
        tone_ = pulse;
        return;
    }
    step_ = pulse.resolution() / steps_per_width;
    const auto steps = static_cast<size_t>(std::ceil(reach_ / step_)) + 1;
    integral_.push_back(0);
    for (size_t i = 0; i <= steps; ++i) {
        response_.push_back(pulse.response(static_cast<double>(i) * step_));
        if (i > 0) integral_.push_back(integral_.back() + step_ * (response_[i - 1] + response_[i]) / 2);
    }
}

double EchoShape::integralTo(double distance) const {
    const double at = std::min(std::abs(distance), reach_) / step_;
    const auto i = static_cast<size_t>(at);
    const double rest = at - static_cast<double>(i), slope = response_[i + 1] - response_[i];
    return std::copysign(integral_[i] + step_ * rest * (response_[i] + rest * slope / 2), distance);
}

double EchoShape::mean(double low, double high) const {
    if (tone_) return tone_->mean(low, high);
    return (integralTo(high) - integralTo(low)) / (high - low);
}

std::optional<EchoShape> echoShape(const RenderPlan& plan) {
    if (!plan.has(Pass::Pulse)) return {};
    return EchoShape(acoustics::Pulse(*plan.config.pulse, plan.grid.speed_of_sound));
}

}  // namespace insonify::sonar
