#include "components/dds/ParameterServer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "components/ros/Cdr.hpp"
#include "components/ros/Stamps.hpp"
#include "types/Thread.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::dds {
namespace {

constexpr const char* sim_time = "use_sim_time";

uint8_t typeNumber(ros::ParameterType type) { return static_cast<uint8_t>(type); }

ros::ParameterValue getValue(const types::PropertyValue& property) {
    ros::ParameterValue value;
    if (const bool* flag = std::get_if<bool>(&property)) {
        value.type = typeNumber(ros::ParameterType::Bool);
        value.bool_value = *flag;
    } else if (const int64_t* whole = std::get_if<int64_t>(&property)) {
        value.type = typeNumber(ros::ParameterType::Integer);
        value.integer_value = *whole;
    } else if (const double* real = std::get_if<double>(&property)) {
        value.type = typeNumber(ros::ParameterType::Double);
        value.double_value = *real;
    } else {
        value.type = typeNumber(ros::ParameterType::String);
        value.string_value = std::get<std::string>(property);
    }
    return value;
}

/** Whether two values are the same bit for bit, also those that are not numbers. */
bool same(const ros::ParameterValue& a, const ros::ParameterValue& b) {
    std::vector<char> bytes_a, bytes_b;
    ros::encode(a, bytes_a);
    ros::encode(b, bytes_b);
    return bytes_a == bytes_b;
}

/** Formats a number as YAML. */
std::string realText(double value) {
    return std::isnan(value) ? ".nan" : std::isinf(value) ? (value > 0 ? ".inf" : "-.inf") : fmt::format("{}", value);
}

std::string quotedText(const std::string& text) {
    std::string result = "\"";
    for (const char c : text)
        if (c == '\n')
            result += "\\n";
        else
            result += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
    return result + "\"";
}

/** Formats a value as a setter accepts it. @param is_text whether the property is a text; else texts are YAML.
 *  Throws std::runtime_error for an unknown type. */
std::string yaml(const ros::ParameterValue& value, bool is_text) {
    const auto list = [](const auto& items, const auto& text) {
        std::vector<std::string> texts;
        for (const auto& item : items) texts.push_back(text(item));
        return fmt::format("[{}]", fmt::join(texts, ", "));
    };
    const auto whole = [](auto item) { return std::to_string(static_cast<int64_t>(item)); };
    switch (static_cast<ros::ParameterType>(value.type)) {
        case ros::ParameterType::NotSet: return "null";
        case ros::ParameterType::Bool: return value.bool_value ? "true" : "false";
        case ros::ParameterType::Integer: return std::to_string(value.integer_value);
        case ros::ParameterType::Double: return realText(value.double_value);
        case ros::ParameterType::String: return is_text ? quotedText(value.string_value) : value.string_value;
        case ros::ParameterType::ByteArray: return list(value.byte_array_value, whole);
        case ros::ParameterType::BoolArray:
            return list(value.bool_array_value,
                        [](ros::Truth item) { return item == ros::Truth::Yes ? "true" : "false"; });
        case ros::ParameterType::IntegerArray: return list(value.integer_array_value, whole);
        case ros::ParameterType::DoubleArray: return list(value.double_array_value, realText);
        case ros::ParameterType::StringArray: return list(value.string_array_value, quotedText);
    }
    throw std::runtime_error(fmt::format("a parameter has no type {}", value.type));
}

ros::ParameterValue valueNamed(const auto& values, const std::string& name) {
    for (const auto& [each, value] : values)
        if (each == name) return value;
    return {};
}

/** Returns none if there is no such property. */
std::optional<types::PropertyInfo> getInfo(const types::DeploymentControl& deployment, const std::string& name) {
    for (const types::TaskInterface& task : deployment.interfaces())
        for (const types::PropertyInfo& info : task.properties)
            if (task.name + "." + info.name == name) return info;
    return std::nullopt;
}

void listParameters(const auto& values, const ros::ListParametersRequest& request,
                    ros::ListParametersResult& response) {
    const auto isWanted = [&](const std::string& name, const std::string& prefix) {
        if (!prefix.empty() && name == prefix) return true;
        if (!prefix.empty() && !name.starts_with(prefix + ".")) return false;
        const auto words = std::count(name.begin() + static_cast<std::ptrdiff_t>(prefix.size()), name.end(), '.') +
                           static_cast<std::ptrdiff_t>(prefix.empty());
        return request.depth == 0 || static_cast<uint64_t>(words) <= request.depth;
    };
    const std::vector<std::string> all{""};
    std::set<std::string> prefixes;
    for (const auto& [name, value] : values)
        for (const std::string& prefix : request.prefixes.empty() ? all : request.prefixes)
            if (isWanted(name, prefix)) {
                response.names.push_back(name);
                if (name.find('.') != std::string::npos) prefixes.insert(name.substr(0, name.rfind('.')));
                break;
            }
    response.prefixes.assign(prefixes.begin(), prefixes.end());
}

}  // namespace

ParameterServer::ParameterServer(NodeServer& server, std::string own, types::DeploymentControl& deployment,
                                 SetProperties set, std::function<bool()> use_sim_time)
    : server_(server),
      own_(std::move(own)),
      deployment_(deployment),
      set_(std::move(set)),
      use_sim_time_(std::move(use_sim_time)),
      events_(server.node(), server.named("/parameter_events"), {.reliability = Reliability::Reliable, .depth = 1000}) {
    offer();
    constexpr auto seldom = std::chrono::milliseconds(200);
    server_.every(seldom, [this] { sendChanges(); });
}

void ParameterServer::offer() {
    server_.serve(ros::list_parameters,
                  {[this](const auto& request, auto& response) { listParameters(values(), request, response.field); }});
    server_.serve(ros::get_parameters, {[this](const auto& request, auto& response) {
                      const Values all = values();
                      for (const std::string& name : request.field) response.field.push_back(valueNamed(all, name));
                  }});
    server_.serve(ros::get_parameter_types, {[this](const auto& request, auto& response) {
                      const Values all = values();
                      for (const std::string& name : request.field)
                          response.field.push_back(valueNamed(all, name).type);
                  }});
    server_.serve(ros::describe_parameters, {[this](const auto& request, auto& response) {
                      const Values all = values();
                      for (const std::string& name : request.field) response.field.push_back(descriptor(all, name));
                  }});
    server_.serve(ros::set_parameters, {[this](const auto& request, auto& response) {
                      for (const ros::Parameter& parameter : request.field)
                          response.field.push_back(setAll({&parameter, 1}));
                  }});
    server_.serve(ros::set_parameters_atomically,
                  {[this](const auto& request, auto& response) { response.field = setAll(request.field); }});
}

ParameterServer::Values ParameterServer::valuesIn(const types::DeploymentStatus& status) const {
    Values values{{sim_time, getValue(use_sim_time_())}};
    for (const types::TaskStatus& task : status.tasks)
        for (const auto& [name, value] : task.record.properties)
            values.emplace_back(task.record.name + "." + name, getValue(value));
    return values;
}

ros::ParameterDescriptor ParameterServer::descriptor(const Values& values, const std::string& name) const {
    ros::ParameterDescriptor descriptor;
    descriptor.name = name;
    descriptor.type = valueNamed(values, name).type;
    descriptor.read_only = name == sim_time || name.starts_with(own_ + ".");
    if (name == sim_time) descriptor.description = "whether stamps are by another clock than the wall clock";
    const auto info = getInfo(deployment_, name);
    if (!info) return descriptor;
    descriptor.description = info->doc + (info->unit.empty() || info->unit == "1" ? "" : " [" + info->unit + "]");
    descriptor.additional_constraints = info->type;
    descriptor.dynamic_typing = true;  // null removes a value
    if (!std::isfinite(info->min) || !std::isfinite(info->max)) return descriptor;
    if (descriptor.type == typeNumber(ros::ParameterType::Double))
        descriptor.floating_point_range.push_back({info->min, info->max, 0});
    if (descriptor.type == typeNumber(ros::ParameterType::Integer) && std::abs(info->min) < 9e18 &&
        std::abs(info->max) < 9e18)
        descriptor.integer_range.push_back({static_cast<int64_t>(info->min), static_cast<int64_t>(info->max), 1});
    return descriptor;
}

void ParameterServer::prepare(const Values& values, const ros::Parameter& parameter,
                              std::map<std::string, std::string>& to_set) const {
    if (same(valueNamed(values, parameter.name), parameter.value) && parameter.value.type != 0) return;
    if (parameter.name == sim_time)
        throw std::runtime_error(
            fmt::format("is {}, by the deployment's schedule and tasks; it cannot be set", use_sim_time_()));
    const auto info = getInfo(deployment_, parameter.name);
    if (!info) throw std::runtime_error("is not a property of any task");
    if (parameter.name.starts_with(own_ + "."))
        throw std::runtime_error("is a property of the task that serves parameters, which is read-only");
    if (!to_set.emplace(parameter.name, yaml(parameter.value, info->type == "string")).second)
        throw std::runtime_error("is given twice");
}

ros::SetParametersResult ParameterServer::setAll(std::span<const ros::Parameter> parameters) try {
    std::map<std::string, std::string> to_set;
    const Values all = values();
    for (const ros::Parameter& parameter : parameters) try {
            prepare(all, parameter, to_set);
        } catch (const std::exception& error) {
            return {false, parameter.name + ": " + types::getReason(error)};
        }
    if (!to_set.empty()) set_(to_set);
    sendChanges();
    return {true, ""};
} catch (const std::exception& error) {
    return {false, types::getReason(error)};
}

void ParameterServer::sendChanges() {
    const types::DeploymentStatus status = deployment_.status();
    Values now = valuesIn(status);
    ros::ParameterEvent event;
    for (const auto& [name, value] : now) {
        const ros::ParameterValue before = valueNamed(sent_, name);
        if (before.type == 0)
            event.new_parameters.push_back({name, value});
        else if (!same(before, value))
            event.changed_parameters.push_back({name, value});
    }
    for (const auto& [name, value] : sent_)
        if (valueNamed(now, name).type == 0) event.deleted_parameters.push_back({name, value});
    sent_ = std::move(now);
    if (event.new_parameters.empty() && event.changed_parameters.empty() && event.deleted_parameters.empty()) return;
    event.stamp = ros::toRos(status.now);
    event.node = server_.nodeName();
    events_.send(event);
}

}  // namespace insonify::dds
