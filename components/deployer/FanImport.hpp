#pragma once
#include <filesystem>
#include <optional>

#include "components/deployer/Import.hpp"

namespace insonify::deployer {

/** Imports a recording of an ARIS or a Gemini, see importRecording. Throws types::ConfigError for a file without a
 *  ping. */
Imported importFan(const std::filesystem::path& recording, std::optional<framework::DeploymentSpec> spec,
                   const std::filesystem::path& to);

}  // namespace insonify::deployer
