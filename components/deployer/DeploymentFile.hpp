#pragma once
#include <string>

namespace insonify::deployer {

/** The deployment that is meant: a file as it is; of a folder its one file .yml or .yaml with `tasks`. Throws
 *  types::ConfigError, naming what is there, when a folder has none or several. */
std::string deploymentIn(const std::string& path);

}  // namespace insonify::deployer
