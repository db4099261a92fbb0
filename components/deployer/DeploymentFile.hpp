#pragma once
#include <string>

namespace insonify::deployer {

/** Returns the deployment file of a path: the file itself, or in a folder its only .yml or .yaml file with `tasks`.
 *  Throws types::ConfigError, with the candidates, when a folder has none or several. */
std::string deploymentIn(const std::string& path);

}  // namespace insonify::deployer
