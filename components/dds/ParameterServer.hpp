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
#include "types/samples/DeploymentControl.hpp"
#include "types/text/Describe.hpp"

namespace insonify::dds {

// rcl_interfaces: the messages of a node's parameter services, field for field. See ros/GeometryMessages.hpp.
/** rcl_interfaces/msg/ParameterType. */
enum class ParameterType : uint8_t {
    NotSet,
    Bool,
    Integer,
    Double,
    String,
    ByteArray,
    BoolArray,
    IntegerArray,
    DoubleArray,
    StringArray
};

struct ParameterValue {
    static constexpr const char* type_name = "rcl_interfaces/msg/ParameterValue";
    static constexpr const char* type_hash = "";
    uint8_t type = 0;
    bool bool_value = false;
    int64_t integer_value = 0;
    double double_value = 0;
    std::string string_value;
    std::vector<uint8_t> byte_array_value, bool_array_value;
    std::vector<int64_t> integer_array_value;
    std::vector<double> double_array_value;
    std::vector<std::string> string_array_value;

    static void describe(auto& self, auto& visit) {
        visit({"type"}, self.type);
        visit({"bool_value"}, self.bool_value);
        visit({"integer_value"}, self.integer_value);
        visit({"double_value"}, self.double_value);
        visit({"string_value"}, self.string_value);
        visit({"byte_array_value"}, self.byte_array_value);
        visit({"bool_array_value"}, self.bool_array_value);
        visit({"integer_array_value"}, self.integer_array_value);
        visit({"double_array_value"}, self.double_array_value);
        visit({"string_array_value"}, self.string_array_value);
    }
};

struct Parameter {
    static constexpr const char* type_name = "rcl_interfaces/msg/Parameter";
    static constexpr const char* type_hash = "";
    std::string name;
    ParameterValue value;

    static void describe(auto& self, auto& visit) {
        visit({"name"}, self.name);
        visit({"value"}, self.value);
    }
};

struct SetParametersResult {
    static constexpr const char* type_name = "rcl_interfaces/msg/SetParametersResult";
    static constexpr const char* type_hash = "";
    bool successful = false;
    std::string reason;

    static void describe(auto& self, auto& visit) {
        visit({"successful"}, self.successful);
        visit({"reason"}, self.reason);
    }
};

/** Bounds of a number. `step` 0 allows any number between them. */
template <class Number, class Step>
struct ParameterRange {
    static constexpr const char* type_name = "rcl_interfaces/msg/Range";  // no name on the wire
    static constexpr const char* type_hash = "";
    Number from_value = 0, to_value = 0;
    Step step = 0;

    static void describe(auto& self, auto& visit) {
        visit({"from_value"}, self.from_value);
        visit({"to_value"}, self.to_value);
        visit({"step"}, self.step);
    }
};

struct ParameterDescriptor {
    static constexpr const char* type_name = "rcl_interfaces/msg/ParameterDescriptor";
    static constexpr const char* type_hash = "";
    std::string name;
    uint8_t type = 0;
    std::string description, additional_constraints;
    bool read_only = false, dynamic_typing = false;
    std::vector<ParameterRange<double, double>> floating_point_range;
    std::vector<ParameterRange<int64_t, uint64_t>> integer_range;

    static void describe(auto& self, auto& visit) {
        visit({"name"}, self.name);
        visit({"type"}, self.type);
        visit({"description"}, self.description);
        visit({"additional_constraints"}, self.additional_constraints);
        visit({"read_only"}, self.read_only);
        visit({"dynamic_typing"}, self.dynamic_typing);
        visit({"floating_point_range"}, self.floating_point_range);
        visit({"integer_range"}, self.integer_range);
    }
};

/** A request or a response with one field. */
template <class T>
struct OneField {
    static constexpr const char* type_name = "rcl_interfaces/srv/OneField";  // no name on the wire
    static constexpr const char* type_hash = "";
    T field;

    static void describe(auto& self, auto& visit) { visit({"field"}, self.field); }
};

struct ListParametersRequest {
    static constexpr const char* type_name = "rcl_interfaces/srv/ListParameters_Request";
    static constexpr const char* type_hash = "";
    std::vector<std::string> prefixes;
    uint64_t depth = 0;  ///< Max number of words after the prefix; 0: any.

    static void describe(auto& self, auto& visit) {
        visit({"prefixes"}, self.prefixes);
        visit({"depth"}, self.depth);
    }
};

struct ListParametersResponse {
    static constexpr const char* type_name = "rcl_interfaces/srv/ListParameters_Response";
    static constexpr const char* type_hash = "";
    std::vector<std::string> names, prefixes;

    static void describe(auto& self, auto& visit) {
        visit({"names"}, self.names);
        visit({"prefixes"}, self.prefixes);
    }
};

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
