#pragma once
#include <string>

#include "components/ros/ElementMessages.hpp"
#include "types/SonarElements.hpp"

namespace insonify::ros {

// Signals of elements as messages and back, number for number. Throw std::out_of_range for a time that ROS cannot hold,
// and std::invalid_argument for lists of unequal lengths.

void convert(const types::SonarElements& signals, const std::string& frame_id, SonarElements& message);
void convert(const SonarElements& message, types::SonarElements& signals);

}  // namespace insonify::ros
