#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/DeploymentSpec.hpp"
#include "components/log/Reader.hpp"

namespace insonify::deployer {

/** The seed that a log was recorded with; none when that is not known. */
std::optional<uint64_t> recordedSeed(const log::Reader& log);

/** What the tasks from which a log's pings come were set to and the deployment does not say, as `--set` takes it: the
 *  properties in `properties.0.log` beside the log, where that is of the same run, and each sonar's quality as its plan
 *  tells. Of a sonar whose quality `set` names, not the quality.
 *  @param seed given for this run; none: the log's. */
std::vector<std::string> recordedSettings(const log::Reader& log, const framework::DeploymentSpec& spec,
                                          const std::vector<std::string>& set, std::optional<uint64_t> seed);

}  // namespace insonify::deployer
