#pragma once
// Messages and services of every ROS 2 node: rcl_interfaces, lifecycle_msgs and diagnostic_msgs, field for field. See
// Messages.hpp.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "components/ros/Cdr.hpp"
#include "components/ros/Messages.hpp"

namespace insonify::ros {

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
    uint8_t type = 0;
    bool bool_value = false;
    int64_t integer_value = 0;
    double double_value = 0;
    std::string string_value;
    std::vector<std::byte> byte_array_value;
    std::vector<Truth> bool_array_value;
    std::vector<int64_t> integer_array_value;
    std::vector<double> double_array_value;
    std::vector<std::string> string_array_value;

    friend bool operator==(const ParameterValue&, const ParameterValue&) = default;
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
    std::string name;
    ParameterValue value;

    friend bool operator==(const Parameter&, const Parameter&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"name"}, self.name);
        visit({"value"}, self.value);
    }
};

struct ParameterEvent {
    static constexpr const char* type_name = "rcl_interfaces/msg/ParameterEvent";
    Time stamp;
    std::string node;
    std::vector<Parameter> new_parameters;
    std::vector<Parameter> changed_parameters;
    std::vector<Parameter> deleted_parameters;

    friend bool operator==(const ParameterEvent&, const ParameterEvent&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"stamp"}, self.stamp);
        visit({"node"}, self.node);
        visit({"new_parameters"}, self.new_parameters);
        visit({"changed_parameters"}, self.changed_parameters);
        visit({"deleted_parameters"}, self.deleted_parameters);
    }
};

struct SetParametersResult {
    static constexpr const char* type_name = "rcl_interfaces/msg/SetParametersResult";
    bool successful = false;
    std::string reason;

    friend bool operator==(const SetParametersResult&, const SetParametersResult&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"successful"}, self.successful);
        visit({"reason"}, self.reason);
    }
};

/** Bounds of a number. `step` 0 allows any number between them. */
struct FloatingPointRange {
    static constexpr const char* type_name = "rcl_interfaces/msg/FloatingPointRange";
    double from_value = 0;
    double to_value = 0;
    double step = 0;

    friend bool operator==(const FloatingPointRange&, const FloatingPointRange&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"from_value"}, self.from_value);
        visit({"to_value"}, self.to_value);
        visit({"step"}, self.step);
    }
};

struct IntegerRange {
    static constexpr const char* type_name = "rcl_interfaces/msg/IntegerRange";
    int64_t from_value = 0;
    int64_t to_value = 0;
    uint64_t step = 0;

    friend bool operator==(const IntegerRange&, const IntegerRange&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"from_value"}, self.from_value);
        visit({"to_value"}, self.to_value);
        visit({"step"}, self.step);
    }
};

struct ParameterDescriptor {
    static constexpr const char* type_name = "rcl_interfaces/msg/ParameterDescriptor";
    std::string name;
    uint8_t type = 0;
    std::string description;
    std::string additional_constraints;
    bool read_only = false;
    bool dynamic_typing = false;
    Bounded<FloatingPointRange, 1> floating_point_range;
    Bounded<IntegerRange, 1> integer_range;

    friend bool operator==(const ParameterDescriptor&, const ParameterDescriptor&) = default;
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

struct ListParametersResult {
    static constexpr const char* type_name = "rcl_interfaces/msg/ListParametersResult";
    std::vector<std::string> names;
    std::vector<std::string> prefixes;

    friend bool operator==(const ListParametersResult&, const ListParametersResult&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"names"}, self.names);
        visit({"prefixes"}, self.prefixes);
    }
};

/** `level`: 10 debug, 20 info, 30 warning, 40 error, 50 fatal. */
struct Log {
    static constexpr const char* type_name = "rcl_interfaces/msg/Log";
    Time stamp;
    uint8_t level = 0;
    std::string name;
    std::string msg;
    std::string file;
    std::string function;
    uint32_t line = 0;

    friend bool operator==(const Log&, const Log&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"stamp"}, self.stamp);
        visit({"level"}, self.level);
        visit({"name"}, self.name);
        visit({"msg"}, self.msg);
        visit({"file"}, self.file);
        visit({"function"}, self.function);
        visit({"line"}, self.line);
    }
};

struct State {
    static constexpr const char* type_name = "lifecycle_msgs/msg/State";
    uint8_t id = 0;
    std::string label;

    friend bool operator==(const State&, const State&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"id"}, self.id);
        visit({"label"}, self.label);
    }
};

struct Transition {
    static constexpr const char* type_name = "lifecycle_msgs/msg/Transition";
    uint8_t id = 0;
    std::string label;

    friend bool operator==(const Transition&, const Transition&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"id"}, self.id);
        visit({"label"}, self.label);
    }
};

struct TransitionDescription {
    static constexpr const char* type_name = "lifecycle_msgs/msg/TransitionDescription";
    Transition transition;
    State start_state;
    State goal_state;

    friend bool operator==(const TransitionDescription&, const TransitionDescription&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"transition"}, self.transition);
        visit({"start_state"}, self.start_state);
        visit({"goal_state"}, self.goal_state);
    }
};

struct TransitionEvent {
    static constexpr const char* type_name = "lifecycle_msgs/msg/TransitionEvent";
    uint64_t timestamp = 0;
    Transition transition;
    State start_state;
    State goal_state;

    friend bool operator==(const TransitionEvent&, const TransitionEvent&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"timestamp"}, self.timestamp);
        visit({"transition"}, self.transition);
        visit({"start_state"}, self.start_state);
        visit({"goal_state"}, self.goal_state);
    }
};

struct KeyValue {
    static constexpr const char* type_name = "diagnostic_msgs/msg/KeyValue";
    std::string key;
    std::string value;

    friend bool operator==(const KeyValue&, const KeyValue&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"key"}, self.key);
        visit({"value"}, self.value);
    }
};

/** `level`: 0 right, 1 warning, 2 error, 3 stale. */
struct DiagnosticStatus {
    static constexpr const char* type_name = "diagnostic_msgs/msg/DiagnosticStatus";
    std::byte level{0};
    std::string name;
    std::string message;
    std::string hardware_id;
    std::vector<KeyValue> values;

    friend bool operator==(const DiagnosticStatus&, const DiagnosticStatus&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"level"}, self.level);
        visit({"name"}, self.name);
        visit({"message"}, self.message);
        visit({"hardware_id"}, self.hardware_id);
        visit({"values"}, self.values);
    }
};

struct DiagnosticArray {
    static constexpr const char* type_name = "diagnostic_msgs/msg/DiagnosticArray";
    Header header;
    std::vector<DiagnosticStatus> status;

    friend bool operator==(const DiagnosticArray&, const DiagnosticArray&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"header"}, self.header);
        visit({"status"}, self.status);
    }
};

/** A text as a template's argument. */
template <size_t size>
struct Text {
    char text[size];
    constexpr Text(const char (&given)[size]) { std::copy_n(given, size, text); }  // NOLINT: from a literal
};

/** A request or a response with one field. */
template <Text type, Text name, class T>
struct OneField {
    static constexpr const char* type_name = type.text;
    T field{};

    static void describe(auto& self, auto& visit) { visit({name.text}, self.field); }
};
/** A request without fields; on the wire it has this one. */
template <Text type>
using Empty = OneField<type, "structure_needs_at_least_one_member", uint8_t>;

struct ListParametersRequest {
    static constexpr const char* type_name = "rcl_interfaces/srv/ListParameters_Request";
    std::vector<std::string> prefixes;
    uint64_t depth = 0;  ///< Max number of words after the prefix; 0: any.

    static void describe(auto& self, auto& visit) {
        visit({"prefixes"}, self.prefixes);
        visit({"depth"}, self.depth);
    }
};

/** A service: its name, and the types of its request and response. */
template <class RequestType, class ResponseType>
struct Service {
    using Request = RequestType;
    using Response = ResponseType;
    const char* name;
};

inline constexpr Service<ListParametersRequest,
                         OneField<"rcl_interfaces/srv/ListParameters_Response", "result", ListParametersResult>>
    list_parameters{"list_parameters"};
inline constexpr Service<OneField<"rcl_interfaces/srv/GetParameters_Request", "names", std::vector<std::string>>,
                         OneField<"rcl_interfaces/srv/GetParameters_Response", "values", std::vector<ParameterValue>>>
    get_parameters{"get_parameters"};
inline constexpr Service<OneField<"rcl_interfaces/srv/GetParameterTypes_Request", "names", std::vector<std::string>>,
                         OneField<"rcl_interfaces/srv/GetParameterTypes_Response", "types", std::vector<uint8_t>>>
    get_parameter_types{"get_parameter_types"};
inline constexpr Service<
    OneField<"rcl_interfaces/srv/DescribeParameters_Request", "names", std::vector<std::string>>,
    OneField<"rcl_interfaces/srv/DescribeParameters_Response", "descriptors", std::vector<ParameterDescriptor>>>
    describe_parameters{"describe_parameters"};
inline constexpr Service<
    OneField<"rcl_interfaces/srv/SetParameters_Request", "parameters", std::vector<Parameter>>,
    OneField<"rcl_interfaces/srv/SetParameters_Response", "results", std::vector<SetParametersResult>>>
    set_parameters{"set_parameters"};
inline constexpr Service<
    OneField<"rcl_interfaces/srv/SetParametersAtomically_Request", "parameters", std::vector<Parameter>>,
    OneField<"rcl_interfaces/srv/SetParametersAtomically_Response", "result", SetParametersResult>>
    set_parameters_atomically{"set_parameters_atomically"};

inline constexpr Service<OneField<"lifecycle_msgs/srv/ChangeState_Request", "transition", Transition>,
                         OneField<"lifecycle_msgs/srv/ChangeState_Response", "success", bool>>
    change_state{"change_state"};
inline constexpr Service<Empty<"lifecycle_msgs/srv/GetState_Request">,
                         OneField<"lifecycle_msgs/srv/GetState_Response", "current_state", State>>
    get_state{"get_state"};
inline constexpr Service<
    Empty<"lifecycle_msgs/srv/GetAvailableStates_Request">,
    OneField<"lifecycle_msgs/srv/GetAvailableStates_Response", "available_states", std::vector<State>>>
    get_available_states{"get_available_states"};
using Transitions = Service<Empty<"lifecycle_msgs/srv/GetAvailableTransitions_Request">,
                            OneField<"lifecycle_msgs/srv/GetAvailableTransitions_Response", "available_transitions",
                                     std::vector<TransitionDescription>>>;
inline constexpr Transitions get_available_transitions{"get_available_transitions"};
inline constexpr Transitions get_transition_graph{"get_transition_graph"};

/** Calls `use` with a default message of each type above. */
void forEachNodeMessage(auto&& use) {
    const auto each = [&](auto... message) { (use(message), ...); };
    each(ParameterValue{}, Parameter{}, ParameterEvent{}, SetParametersResult{}, FloatingPointRange{}, IntegerRange{},
         ParameterDescriptor{}, ListParametersResult{}, Log{}, State{}, Transition{}, TransitionDescription{},
         TransitionEvent{}, KeyValue{}, DiagnosticStatus{}, DiagnosticArray{});
    const auto both = [&](const auto&... service) {
        (use(typename std::remove_cvref_t<decltype(service)>::Request{}), ...);
        (use(typename std::remove_cvref_t<decltype(service)>::Response{}), ...);
    };
    both(list_parameters, get_parameters, get_parameter_types, describe_parameters, set_parameters,
         set_parameters_atomically, change_state, get_state, get_available_states, get_available_transitions);
}

}  // namespace insonify::ros
