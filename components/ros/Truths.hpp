#pragma once
#include <string>

#include "components/ros/TruthMessages.hpp"
#include "types/SonarReturns.hpp"
#include "types/SonarTruth.hpp"

namespace insonify::ros {

// What pings show as messages and back, number for number. Throw std::out_of_range for a time that ROS cannot hold, and
// std::invalid_argument for lists of unequal lengths.

void convert(const types::SonarTruth& truth, const std::string& frame_id, SonarTruth& message);
void convert(const types::SonarReturns& returns, const std::string& frame_id, SonarReturns& message);
void convert(const SonarTruth& message, types::SonarTruth& truth);
void convert(const SonarReturns& message, types::SonarReturns& returns);

}  // namespace insonify::ros
