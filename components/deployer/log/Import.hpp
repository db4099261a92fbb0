#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/config/DeploymentSpec.hpp"

namespace insonify::deployer {

/** The result of importing a recording. */
struct Imported {
    size_t pings = 0;
    std::string stream;                     ///< The stream of pings.
    std::vector<std::string> properties{};  ///< For the first ping, as the recording states them, for `--set`.
    size_t changes = 0;                     ///< How often the properties changed after the first ping.
    std::vector<std::string> notices{};     ///< What was skipped or is unknown.
};

/** Makes a log of a recording of another program or device, which its content identifies
 * (recordings/RecordingReader.hpp has the formats). The log has every ping, and can be exported and replayed like a
 * recorded run.
 *
 *  With a deployment, the pings become those of its receiver that outputs codes, and poses use its names. Next to the
 *  log, properties.0.log has the settings of sonar and receiver at each ping, so that the log can be rendered again and
 *  scored. Without a deployment, the tasks are called sonar, receiver and vehicle. A side-scan's file has its own poses
 * and altitudes, an .aris file may have poses and altitudes. Gemini and Oculus recordings have none, and get those of
 * the deployment's trajectories. A network capture without times starts at 1 s.
 *  @throws types::ConfigError if the file is not a recording, or the deployment lacks these tasks */
Imported importRecording(const std::filesystem::path& recording, std::optional<framework::DeploymentSpec> spec,
                         const std::filesystem::path& to);

}  // namespace insonify::deployer
