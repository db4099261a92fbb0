#pragma once
#include <string>
#include <vector>

#include "components/study/CodedPing.hpp"

namespace insonify::study {

/** The pings of Oculus recordings, files or folders of them, each once, named by its number: "recorded_5".
 *  @throws types::ConfigError where a file holds none, or a folder no file */
std::vector<CodedPing> recordedPings(const std::vector<std::string>& names);

}  // namespace insonify::study
