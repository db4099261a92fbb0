#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "components/dds/Endpoints.hpp"
#include "types/DeploymentControl.hpp"

namespace insonify::dds {

/** Serves the properties of a deployment's tasks ("sonar.range") as parameters of a ROS 2 node.
 *
 *  Services: `list_parameters`, `get_parameters`, `get_parameter_types`, `set_parameters` and `describe_parameters`,
 *  for clients with `rmw_cyclonedds_cpp`. Its requests begin with the sender's identity of 16 bytes. Blocks and lists
 *  are YAML texts. Invalid requests are ignored. Runs on its own thread, because a property is set on the thread of its
 *  task. */
class ParameterServer {
public:
    /** @param node_name the full name
     *  @param own the task that runs this server; its properties are read-only here
     *  Node and deployment must outlive the server. Throws types::ConfigError. */
    ParameterServer(Node& node, const std::string& node_name, std::string own, types::DeploymentControl& deployment);
    ~ParameterServer();
    ParameterServer(const ParameterServer&) = delete;
    ParameterServer& operator=(const ParameterServer&) = delete;

private:
    using Answer = std::function<void(const Bytes& request, Bytes& reply)>;
    struct Service {
        Service(Node& node, const std::string& topic, const std::string& type, std::function<void()> arrived,
                Answer how);
        Reader requests;
        Writer replies;
        Answer answer;
    };

    template <class Request, class Response>
    void serve(Node& node, const std::string& service, const std::string& type,
               std::function<void(const Request&, Response&)> answer);
    void offer(Node& node);
    void work();

    std::string prefix_, own_;
    types::DeploymentControl& deployment_;
    std::mutex mutex_;
    std::condition_variable arrived_;
    bool has_arrived_ = false;
    std::atomic<bool> ends_{false};  ///< Changes under the mutex.
    std::vector<std::unique_ptr<Service>> services_;
    std::thread thread_;
};

}  // namespace insonify::dds
