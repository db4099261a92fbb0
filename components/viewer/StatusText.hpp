#pragma once
#include <string>
#include <vector>

#include "components/viewer/Server.hpp"
#include "types/DeploymentControl.hpp"

namespace insonify::viewer {

/** Returns the state of the deployment as JSON for pages. */
std::string statusText(const types::DeploymentStatus& status, const ServerCounts& counts);
/** Returns all properties, named "sonar.range", as JSON values. */
Parameters parametersOf(const types::DeploymentStatus& status);
std::string interfacesText(const std::vector<types::TaskInterface>& interfaces, bool control);

/** A page's request. */
struct Request {
    enum class Kind { Call, Pause, Step } kind = Kind::Call;
    uint64_t id = 0;                     ///< Repeated in the answer.
    std::string operation;               ///< "sonar.setRange"
    std::vector<std::string> arguments;  ///< In YAML.
    bool on = false;                     ///< For Pause.
};
/** Reads a request. Throws std::invalid_argument with what is wrong; `request` then has what was read before, such as
 *  the id. */
void readRequest(const std::string& text, Request& request);

std::string answerText(uint64_t id, const std::string& result);
std::string refusalText(uint64_t id, const std::string& why);

}  // namespace insonify::viewer
