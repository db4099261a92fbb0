#pragma once
#include <filesystem>
#include <string>

#include "components/deployer/Export.hpp"
#include "components/deployer/Import.hpp"

namespace insonify::device {

/** See deployer::importRecording and deployer::exportOculus. */
deployer::Imported importOculus(const std::filesystem::path& recording, std::optional<framework::DeploymentSpec> spec,
                                const std::filesystem::path& to);
void exportOculus(log::Reader& log, const std::string& stream, const std::filesystem::path& to);

}  // namespace insonify::device
