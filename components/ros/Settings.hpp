#pragma once
#include <string>

#include "components/ros/SettingsMessage.hpp"
#include "types/SonarSettings.hpp"

namespace insonify::ros {

void convert(const types::SonarSettings& settings, const std::string& frame_id, SonarSettings& message);
void convert(const SonarSettings& message, types::SonarSettings& settings);

}  // namespace insonify::ros
