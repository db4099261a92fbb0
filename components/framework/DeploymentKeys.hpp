#pragma once
#include <vector>

#include "components/framework/PropertyList.hpp"

namespace insonify::framework {

/** What a deployment file may say, from the descriptions that it is read by: the keys of the document, of a task and of
 *  a connection, as `describe` lists properties. */
struct DeploymentKeys {
    std::vector<PropertyInfo> document, task, connection;
};
DeploymentKeys deploymentKeys();

}  // namespace insonify::framework
