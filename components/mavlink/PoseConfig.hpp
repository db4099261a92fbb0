#pragma once
#include <glm/vec3.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "types/ConfigError.hpp"
#include "types/Describe.hpp"

namespace insonify::mavlink {

/** The messages that make a pose. */
enum class Source {
    Estimate,  ///< ATTITUDE_QUATERNION and LOCAL_POSITION_NED: the estimate of an autopilot.
    Vision     ///< VISION_POSITION_ESTIMATE: the estimate of another component.
};

/** The source of the poses of one output port. */
struct BodyConfig {
    std::string port = "pose";
    Source source = Source::Estimate;
    int system_id = 1;
    std::optional<int> component_id = {};

    static void describe(auto& self, auto& visit) {
        visit({"port", "", "output port of the poses"}, self.port);
        visit({"source", "",
               "estimate: ATTITUDE_QUATERNION with LOCAL_POSITION_NED, of an autopilot; vision: "
               "VISION_POSITION_ESTIMATE"},
              self.source);
        visit({"system_id", "", "of the vehicle", 1, 255}, self.system_id);
        visit({"component_id", "", "of the sender; absent: any, one at a time", 1, 255}, self.component_id);
    }
};

/** The request for a vehicle's messages. */
struct RequestConfig {
    double rate = 20;

    static void describe(auto& self, auto& visit) { visit({"rate", "Hz", "of each message", 2, 1000}, self.rate); }
};

struct PoseConfig {
    std::string address = "127.0.0.1";
    int port = 14550;
    std::vector<BodyConfig> bodies;
    glm::dvec3 origin{0};
    std::optional<RequestConfig> request = {};

    static void describe(auto& self, auto& visit) {
        visit({"address", "", "numeric address to listen on; 0.0.0.0: every network of this machine"}, self.address);
        visit({"port", "1", "of UDP; 0: any free port, printed in a notice", 0, 65535}, self.port);
        visit({"bodies", "", "bodies whose poses are read"}, self.bodies);
        visit({"origin", "m", "position of the messages' origin in the world: x north, y west, z up"}, self.origin);
        visit({"request", "",
               "requests messages that a vehicle does not send, by SET_MESSAGE_INTERVAL; absent: nothing is ever "
               "sent"},
              self.request);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (bodies.empty()) diagnostics.push_back({"bodies", "is empty; must hold a body"});
        std::set<std::string> ports;
        for (size_t i = 0; i < bodies.size(); ++i)
            if (!ports.insert(bodies[i].port).second)
                diagnostics.push_back(
                    {"bodies[" + std::to_string(i) + "].port", "is " + bodies[i].port + " a second time"});
    }
};

}  // namespace insonify::mavlink

template <>
struct insonify::types::EnumNames<insonify::mavlink::Source> {
    static constexpr std::string_view names[] = {"estimate", "vision"};
};
