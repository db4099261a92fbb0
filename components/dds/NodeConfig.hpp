#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "components/dds/Node.hpp"
#include "components/ros/Options.hpp"
#include "types/ConfigError.hpp"
#include "types/Describe.hpp"
#include "types/RosNames.hpp"

namespace insonify::dds {

/** The configuration of a task's ROS 2 node. */
struct NodeConfig {
    std::string node_name;
    std::optional<uint32_t> domain;
    ros::WorldFrame world_frame = ros::WorldFrame::Enu;
    int gid_size = 16;

    static void describe(auto& self, auto& visit) {
        visit({"domain", "1", "DDS domain; absent: ROS_DOMAIN_ID, or 0", 0, highest_domain}, self.domain);
        visit({"node_name", "", "name of the ROS 2 node, /auv/sonar with a namespace; empty: the task's"},
              self.node_name);
        visit({"world_frame", "",
               "axes of poses on the wire: ours (x north, y west, z up), x east, y north, z up, or x north, y "
               "east, z down"},
              self.world_frame);
        visit({"gid_size", "B", "size of identifiers in ros_discovery_info: 16, or 24 for ROS 2 Humble and before", 16,
               24},
              self.gid_size);
    }
    void check(types::Diagnostics& diagnostics) const {
        if (gid_size != 16 && gid_size != 24)
            diagnostics.push_back({"gid_size", "is " + std::to_string(gid_size) + "; must be 16 or 24"});
        if (const std::string diagnostic = node_name.empty() ? "" : diagnosticOfNode(node_name); !diagnostic.empty())
            diagnostics.push_back({"node_name", diagnostic});
    }
    /** Returns the node's full name. @param task the task's name, used if `node_name` is empty */
    std::string nameIn(const types::RosNames& names, const std::string& task) const {
        return names.node(node_name.empty() ? task : node_name);
    }
};

/** Throws types::ConfigError with the diagnostics of a configuration whose names have been resolved for the
 *  deployment. */
void refuseWrong(const auto& named) {
    types::Diagnostics diagnostics;
    named.check(diagnostics);
    if (!diagnostics.empty()) throw types::ConfigError(diagnostics);
}

}  // namespace insonify::dds

template <>
struct insonify::types::EnumNames<insonify::dds::Reliability> {
    static constexpr std::string_view names[] = {"reliable", "best_effort"};
};
