#pragma once
#include <chrono>
#include <string>

#include "components/gazebo/TransportOptions.hpp"

namespace insonify::gazebo {

/** A service of Gazebo's transport, without the scope of its types: "Empty", "Scene". */
struct Service {
    std::string name;  ///< "/world/sea/scene/info".
    std::string request_type, reply_type;
};

/** What a service answers. */
struct Reply {
    std::string message;  ///< Bytes of its type.
    std::string failure;  ///< Why there is no message, as the rest of a sentence after the service's name.
};

/** Finds a service and asks it once, with a message of these bytes; waits until `timeout` has passed at most. Throws
 *  types::ConfigError: no network takes part, or the transport does not take the name. */
Reply request(const TransportOptions& options, const Service& service, const std::string& message,
              std::chrono::duration<double> timeout);

}  // namespace insonify::gazebo
