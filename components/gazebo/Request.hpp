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

/** The reply of a service. */
struct Reply {
    std::string message;  ///< Bytes of its type.
    std::string failure;  ///< Why there is no message, as the rest of a sentence after the service's name.
};

/** Finds a service and calls it once with a message of these bytes; waits at most `timeout`. Throws types::ConfigError
 *  when no network supports multicast, or the name is invalid for the transport. */
Reply request(const TransportOptions& options, const Service& service, const std::string& message,
              std::chrono::duration<double> timeout);

}  // namespace insonify::gazebo
