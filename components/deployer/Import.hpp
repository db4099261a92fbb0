#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/DeploymentSpec.hpp"

namespace insonify::deployer {

/** What became of a recording. */
struct Imported {
    size_t pings = 0;
    std::string stream;                     ///< The pings'.
    std::vector<std::string> properties{};  ///< That the recording states of its first ping, as `--set` takes them.
    size_t changes = 0;                     ///< How often they changed after it.
    std::vector<std::string> notices{};     ///< What was passed over or is unknown.
};

/** Makes a log of the recording of a device, which its content identifies: an XTF or JSF file of a side-scan, an .aris
 *  file, a Gemini's .glf file, or an Oculus'. The log has every ping, and next to it properties.0.log has the settings
 * of sonar and receiver, as they were at each ping. So it is exported, replayed, rendered again and scored like our
 * own.
 *
 *  With a deployment, pings are those of its receiver that gives out codes, and poses go by its names. Without, tasks
 *  are called sonar, receiver and vehicle. A side-scan's file has its own poses and altitudes, and an ARIS' may have
 * them; a Gemini's and an Oculus' have none, and get those of the deployment's trajectories. A capture, which has no
 * times, starts at 1 s.
 *  @throws types::ConfigError for what is no recording, and for a deployment that lacks such tasks */
Imported importRecording(const std::filesystem::path& recording, std::optional<framework::DeploymentSpec> spec,
                         const std::filesystem::path& to);

}  // namespace insonify::deployer
