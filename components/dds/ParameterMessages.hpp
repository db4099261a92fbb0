#pragma once
// rcl_interfaces: the messages of a node's parameter services, field for field. See ros/GeometryMessages.hpp.
#include <string>
#include <vector>

#include "types/Describe.hpp"

namespace insonify::dds {

using types::Field;

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

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"type"}, self.type);
        visit(Field{"bool_value"}, self.bool_value);
        visit(Field{"integer_value"}, self.integer_value);
        visit(Field{"double_value"}, self.double_value);
        visit(Field{"string_value"}, self.string_value);
        visit(Field{"byte_array_value"}, self.byte_array_value);
        visit(Field{"bool_array_value"}, self.bool_array_value);
        visit(Field{"integer_array_value"}, self.integer_array_value);
        visit(Field{"double_array_value"}, self.double_array_value);
        visit(Field{"string_array_value"}, self.string_array_value);
    }
};

struct Parameter {
    static constexpr const char* type_name = "rcl_interfaces/msg/Parameter";
    static constexpr const char* type_hash = "";
    std::string name;
    ParameterValue value;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"name"}, self.name);
        visit(Field{"value"}, self.value);
    }
};

struct SetParametersResult {
    static constexpr const char* type_name = "rcl_interfaces/msg/SetParametersResult";
    static constexpr const char* type_hash = "";
    bool successful = false;
    std::string reason;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"successful"}, self.successful);
        visit(Field{"reason"}, self.reason);
    }
};

/** Bounds of a number. `step` 0 allows any number between them. */
template <class Number, class Step>
struct ParameterRange {
    static constexpr const char* type_name = "rcl_interfaces/msg/Range";  // no name on the wire
    static constexpr const char* type_hash = "";
    Number from_value = 0, to_value = 0;
    Step step = 0;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"from_value"}, self.from_value);
        visit(Field{"to_value"}, self.to_value);
        visit(Field{"step"}, self.step);
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

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"name"}, self.name);
        visit(Field{"type"}, self.type);
        visit(Field{"description"}, self.description);
        visit(Field{"additional_constraints"}, self.additional_constraints);
        visit(Field{"read_only"}, self.read_only);
        visit(Field{"dynamic_typing"}, self.dynamic_typing);
        visit(Field{"floating_point_range"}, self.floating_point_range);
        visit(Field{"integer_range"}, self.integer_range);
    }
};

/** A request or a response with one field. */
template <class T>
struct OneField {
    static constexpr const char* type_name = "rcl_interfaces/srv/OneField";  // no name on the wire
    static constexpr const char* type_hash = "";
    T field;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"field"}, self.field);
    }
};

struct ListParametersRequest {
    static constexpr const char* type_name = "rcl_interfaces/srv/ListParameters_Request";
    static constexpr const char* type_hash = "";
    std::vector<std::string> prefixes;
    uint64_t depth = 0;  ///< Max number of words after the prefix; 0: any.

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"prefixes"}, self.prefixes);
        visit(Field{"depth"}, self.depth);
    }
};

struct ListParametersResponse {
    static constexpr const char* type_name = "rcl_interfaces/srv/ListParameters_Response";
    static constexpr const char* type_hash = "";
    std::vector<std::string> names, prefixes;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"names"}, self.names);
        visit(Field{"prefixes"}, self.prefixes);
    }
};

}  // namespace insonify::dds
