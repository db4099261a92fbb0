#pragma once
#include <string>

#include "components/framework/Registry.hpp"

namespace insonify::deployer {

/** Returns the path of a file that the user names: `deploy/...`, where the current folder has no such file, is that of
 *  the installed examples, if it is there. */
std::string exampleAt(const std::string& path);

/** Returns the deployment file of such a path: the file itself, or in a folder its only .yml or .yaml file with
 * `tasks`. Throws types::ConfigError, with the candidates, when a folder has none or several. */
std::string deploymentIn(const std::string& path);

/** Returns the task types of the core; types of component libraries are loaded when a deployment names them. */
framework::Registry coreTasks();

/** Returns also the types of all available component libraries. A library that cannot be loaded is a notice on
 *  stderr. */
framework::Registry allTasks();

}  // namespace insonify::deployer
