#pragma once
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "components/dds/NodeServer.hpp"
#include "components/ros/NodeMessages.hpp"
#include "types/samples/DeploymentControl.hpp"

namespace insonify::dds {

/** Sets properties, "sonar.range", to values in YAML: all, or none. Throws std::exception with the reason. */
using SetProperties = std::function<void(const std::map<std::string, std::string>&)>;

/** Serves the properties of a deployment's tasks ("sonar.range") as parameters of a ROS 2 node, by the six services
 * that clients of rclcpp and rclpy wait for, and sends their changes, whoever made them, to /parameter_events.
 *
 *  Blocks and lists are YAML texts. Setting a parameter to its value succeeds and does nothing, so that what was dumped
 *  can be loaded again. `use_sim_time` says whether stamps are by another clock than the wall clock. The deployment
 *  decides that, so it cannot be set. */
class ParameterServer {
public:
    /** @param own the task that runs this server; its properties are read-only here
     *  @param use_sim_time returns the parameter's value
     *  Server and deployment must outlive this. Throws types::ConfigError. */
    ParameterServer(NodeServer& server, std::string own, types::DeploymentControl& deployment, SetProperties set,
                    std::function<bool()> use_sim_time);
    ParameterServer(const ParameterServer&) = delete;
    ParameterServer& operator=(const ParameterServer&) = delete;

private:
    using Values = std::vector<std::pair<std::string, ros::ParameterValue>>;

    void offer();
    /** Returns all parameters, in file order. */
    Values valuesIn(const types::DeploymentStatus& status) const;
    Values values() const { return valuesIn(deployment_.status()); }
    ros::ParameterDescriptor descriptor(const Values& values, const std::string& name) const;
    /** Adds what to set for a parameter, unless it has that value. Throws std::runtime_error for a parameter that
     * cannot be set. */
    void prepare(const Values& values, const ros::Parameter& parameter,
                 std::map<std::string, std::string>& to_set) const;
    ros::SetParametersResult setAll(std::span<const ros::Parameter> parameters);
    void sendChanges();

    NodeServer& server_;
    std::string own_;
    types::DeploymentControl& deployment_;
    SetProperties set_;
    std::function<bool()> use_sim_time_;
    MessageWriter<ros::ParameterEvent> events_;
    Values sent_;  ///< As of the last event.
};

}  // namespace insonify::dds
