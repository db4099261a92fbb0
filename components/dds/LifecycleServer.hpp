#pragma once
#include <functional>
#include <span>
#include <string>

#include "components/dds/NodeServer.hpp"
#include "components/ros/NodeMessages.hpp"
#include "types/samples/DeploymentControl.hpp"

namespace insonify::dds {

/** Makes a node a lifecycle node of ROS 2, whose state is that of one task: the services of rcl_lifecycle and the topic
 *  `~/transition_event`.
 *
 *  PreOperational is unconfigured, Stopped inactive, Running and RunTimeError active, Exception errorprocessing,
 *  FatalError finalized. configure, activate, deactivate and cleanup are the task's configure, start, stop and cleanup.
 *  shutdown stops it and cleans it up; the node then is finalized, as in ROS, until somebody configures the task by
 *  other means. From errorprocessing, transition_success recovers the task. A transition that a state does not have, by
 *  number or by label, is answered with success: false and changes nothing. Changes by others are announced as well. */
class LifecycleServer {
public:
    /** @param report gets the reason of each refusal, for the log
     *  Server and deployment must outlive this. Throws types::ConfigError. */
    LifecycleServer(NodeServer& server, std::string task, types::DeploymentControl& deployment,
                    std::function<void(const std::string&)> report);
    LifecycleServer(const LifecycleServer&) = delete;
    LifecycleServer& operator=(const LifecycleServer&) = delete;

private:
    struct Edge;
    static std::span<const Edge> graph();
    static ros::TransitionDescription described(const Edge& edge);
    static const Edge* find(uint8_t state, uint8_t id, const std::string& label);

    /** Returns ROS's number of the present state. */
    uint8_t state();
    bool change(const ros::Transition& wanted);
    /** Calls the task's operations for a transition. Throws std::exception with the reason. */
    void make(uint8_t transition);
    void announce(const Edge& edge);
    void watch();

    NodeServer& server_;
    std::string task_;
    types::DeploymentControl& deployment_;
    std::function<void(const std::string&)> report_;
    MessageWriter<ros::TransitionEvent> events_;
    bool is_shut_down_ = false;
    uint8_t announced_;  ///< The state of the last event.
};

}  // namespace insonify::dds
