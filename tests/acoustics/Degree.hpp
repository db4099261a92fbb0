#pragma once
#include <numbers>

namespace insonify::acoustics {

constexpr double degree = std::numbers::pi / 180;  // [rad]

}  // namespace insonify::acoustics
