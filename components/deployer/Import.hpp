#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "components/framework/DeploymentSpec.hpp"

namespace insonify::deployer {

/** What became of a recording. */
struct Imported {
    size_t pings = 0;
    size_t other_shape = 0;               ///< Pings of other beams or bins than the first, which were left out.
    std::string stream;                   ///< Of the pings.
    std::vector<std::string> properties;  ///< That the recording tells, as `--set` takes them.
    std::string diagnostic{};             ///< What of the recording was passed over; empty: nothing.
};

/** Makes a log of the recording of an Oculus as the deployment would have written it, had it been the sea: the pings as
 *  those of its receiver, with the poses of its trajectories when they were sent, and beside it properties.0.log with
 *  the properties of all tasks, those of sonar and receiver as the recording tells them. So it is replayed, rendered
 *  again and scored. A capture, which has no times, starts at 1 s.
 *  @throws types::ConfigError for what is no recording, and for a deployment without a fan, trajectory or codes. */
Imported importOculus(const std::filesystem::path& recording, framework::DeploymentSpec spec,
                      const std::filesystem::path& to);

}  // namespace insonify::deployer
