#pragma once
#include <string>
#include <vector>

#include "components/viewer/Server.hpp"
#include "types/DeploymentControl.hpp"

namespace insonify::viewer {

/** JSON for pages. */
std::string statusText(const types::DeploymentStatus& status, const ServerCounts& counts);
/** All properties, "sonar.range", as JSON values. */
Parameters parametersOf(const types::DeploymentStatus& status);
std::string interfacesText(const std::vector<types::TaskInterface>& interfaces, bool control);

/** What a page asks for. */
struct Request {
    enum class Kind { Call, Pause, Step } kind = Kind::Call;
    uint64_t id = 0;                     ///< Comes back in the answer.
    std::string operation;               ///< "sonar.setRange"
    std::vector<std::string> arguments;  ///< In YAML.
    bool on = false;                     ///< Pause.
};
/** Throws std::invalid_argument with what is wrong with the text; what was read before, as the id, is in `request`. */
void readRequest(const std::string& text, Request& request);

std::string answerText(uint64_t id, const std::string& result);
std::string refusalText(uint64_t id, const std::string& why);

}  // namespace insonify::viewer
