#include "components/dds/ParameterServer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>

#include "components/ros/Cdr.hpp"
#include "types/Thread.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::dds {
namespace {

constexpr size_t encapsulation = 4, identity = 16;  ///< At the beginning of a request and of its response [B].
constexpr size_t max_request = size_t{1} << 20;     ///< [B]
const Quality of_services{.reliability = Reliability::Reliable, .depth = 10};

uint8_t typeNumber(ParameterType type) { return static_cast<uint8_t>(type); }

ParameterValue valueOf(const types::PropertyValue& property) {
    ParameterValue value;
    if (const bool* flag = std::get_if<bool>(&property)) {
        value.type = typeNumber(ParameterType::Bool);
        value.bool_value = *flag;
    } else if (const int64_t* whole = std::get_if<int64_t>(&property)) {
        value.type = typeNumber(ParameterType::Integer);
        value.integer_value = *whole;
    } else if (const double* real = std::get_if<double>(&property)) {
        value.type = typeNumber(ParameterType::Double);
        value.double_value = *real;
    } else {
        value.type = typeNumber(ParameterType::String);
        value.string_value = std::get<std::string>(property);
    }
    return value;
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
std::string yaml(const ParameterValue& value, bool is_text) {
    const auto list = [](const auto& items, const auto& text) {
        std::vector<std::string> texts;
        for (const auto& item : items) texts.push_back(text(item));
        return fmt::format("[{}]", fmt::join(texts, ", "));
    };
    const auto whole = [](auto item) { return std::to_string(item); };
    switch (static_cast<ParameterType>(value.type)) {
        case ParameterType::NotSet: return "null";
        case ParameterType::Bool: return value.bool_value ? "true" : "false";
        case ParameterType::Integer: return std::to_string(value.integer_value);
        case ParameterType::Double: return realText(value.double_value);
        case ParameterType::String: return is_text ? quotedText(value.string_value) : value.string_value;
        case ParameterType::ByteArray: return list(value.byte_array_value, whole);
        case ParameterType::BoolArray:
            return list(value.bool_array_value, [](uint8_t item) { return item ? "true" : "false"; });
        case ParameterType::IntegerArray: return list(value.integer_array_value, whole);
        case ParameterType::DoubleArray: return list(value.double_array_value, realText);
        case ParameterType::StringArray: return list(value.string_array_value, quotedText);
    }
    throw std::runtime_error(fmt::format("a parameter has no type {}", value.type));
}

using Values = std::vector<std::pair<std::string, types::PropertyValue>>;

/** Returns all properties by "task.property", in file order. */
Values valuesOf(const types::DeploymentControl& deployment) {
    Values values;
    for (const types::TaskStatus& task : deployment.status().tasks)
        for (const auto& [name, value] : task.record.properties)
            values.emplace_back(task.record.name + "." + name, value);
    return values;
}

ParameterValue valueNamed(const Values& values, const std::string& name) {
    const auto found = std::ranges::find(values, name, &Values::value_type::first);
    return found == values.end() ? ParameterValue{} : valueOf(found->second);
}

/** Returns none if there is no such property. */
std::optional<types::PropertyInfo> infoOf(const types::DeploymentControl& deployment, const std::string& name) {
    for (const types::TaskInterface& task : deployment.interfaces())
        for (const types::PropertyInfo& info : task.properties)
            if (task.name + "." + info.name == name) return info;
    return std::nullopt;
}

void listParameters(const Values& values, const ListParametersRequest& request, ListParametersResponse& response) {
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
                prefixes.insert(name.substr(0, name.rfind('.')));
                break;
            }
    response.prefixes.assign(prefixes.begin(), prefixes.end());
}

SetParametersResult setOne(types::DeploymentControl& deployment, const std::string& own,
                           const Parameter& parameter) try {
    const size_t dot = parameter.name.find('.');
    const auto info = infoOf(deployment, parameter.name);
    if (!info) throw std::runtime_error("is not a property of any task");
    if (parameter.name.substr(0, dot) == own)
        throw std::runtime_error("is a property of the task that serves parameters, which is read-only");
    std::string operation = parameter.name;
    operation[dot + 1] = types::raised(operation[dot + 1]);
    operation.insert(dot + 1, "set");
    deployment.call(operation, {yaml(parameter.value, info->type == "string")});
    return {true, ""};
} catch (const std::exception& error) {
    return {false, parameter.name + ": " + types::reasonOf(error)};
}

ParameterDescriptor descriptorOf(const types::DeploymentControl& deployment, const Values& values,
                                 const std::string& own, const std::string& name) {
    ParameterDescriptor descriptor;
    descriptor.name = name;
    const auto info = infoOf(deployment, name);
    if (!info) return descriptor;
    descriptor.type = valueNamed(values, name).type;
    descriptor.description = info->doc + (info->unit.empty() || info->unit == "1" ? "" : " [" + info->unit + "]");
    descriptor.additional_constraints = info->type;
    descriptor.read_only = name.starts_with(own + ".");
    descriptor.dynamic_typing = true;  // null removes a value
    if (!std::isfinite(info->min) || !std::isfinite(info->max)) return descriptor;
    if (descriptor.type == typeNumber(ParameterType::Double))
        descriptor.floating_point_range = {{info->min, info->max, 0}};
    if (descriptor.type == typeNumber(ParameterType::Integer) && std::abs(info->min) < 9e18 &&
        std::abs(info->max) < 9e18)
        descriptor.integer_range = {{static_cast<int64_t>(info->min), static_cast<int64_t>(info->max), 1}};
    return descriptor;
}

}  // namespace

ParameterServer::ParameterServer(Node& node, const std::string& node_name, std::string own,
                                 types::DeploymentControl& deployment)
    : prefix_(node_name.starts_with('/') ? node_name : "/" + node_name), own_(std::move(own)), deployment_(deployment) {
    offer(node);
    thread_ = types::startThread("the ROS 2 parameters", [this] { work(); });
}

ParameterServer::~ParameterServer() {
    {
        std::lock_guard lock(mutex_);
        ends_ = true;
    }
    arrived_.notify_all();
    thread_.join();
}

ParameterServer::Service::Service(Node& node, const std::string& topic, const std::string& type,
                                  std::function<void()> arrived, Answer how)
    : requests(node, "rq" + topic + "Request", type + "_Request", "", of_services, std::move(arrived), max_request),
      replies(node, "rr" + topic + "Reply", type + "_Response", "", of_services),
      answer(std::move(how)) {}

void ParameterServer::offer(Node& node) {
    using Names = OneField<std::vector<std::string>>;
    serve<ListParametersRequest, ListParametersResponse>(
        node, "list_parameters", "ListParameters",
        [this](const auto& request, auto& response) { listParameters(valuesOf(deployment_), request, response); });
    serve<Names, OneField<std::vector<ParameterValue>>>(node, "get_parameters", "GetParameters",
                                                        [this](const auto& request, auto& response) {
                                                            const Values values = valuesOf(deployment_);
                                                            for (const std::string& name : request.field)
                                                                response.field.push_back(valueNamed(values, name));
                                                        });
    serve<Names, OneField<std::vector<uint8_t>>>(node, "get_parameter_types", "GetParameterTypes",
                                                 [this](const auto& request, auto& response) {
                                                     const Values values = valuesOf(deployment_);
                                                     for (const std::string& name : request.field)
                                                         response.field.push_back(valueNamed(values, name).type);
                                                 });
    serve<OneField<std::vector<Parameter>>, OneField<std::vector<SetParametersResult>>>(
        node, "set_parameters", "SetParameters", [this](const auto& request, auto& response) {
            for (const Parameter& parameter : request.field)
                response.field.push_back(setOne(deployment_, own_, parameter));
        });
    serve<Names, OneField<std::vector<ParameterDescriptor>>>(
        node, "describe_parameters", "DescribeParameters", [this](const auto& request, auto& response) {
            const Values values = valuesOf(deployment_);
            for (const std::string& name : request.field)
                response.field.push_back(descriptorOf(deployment_, values, own_, name));
        });
}

template <class Request, class Response>
void ParameterServer::serve(Node& node, const std::string& service, const std::string& type,
                            std::function<void(const Request&, Response&)> answer) {
    const auto arrived = [this] {
        {
            std::lock_guard lock(mutex_);
            has_arrived_ = true;
        }
        arrived_.notify_all();
    };
    const std::string topic = prefix_ + "/" + service, ros_type = "rcl_interfaces/srv/" + type;
    services_.push_back(std::make_unique<Service>(node, topic, ros_type, arrived,
                                                  [answer = std::move(answer)](const Bytes& request, Bytes& reply) {
                                                      Request asked;
                                                      Response said;
                                                      ros::decode(std::span<const char>(request), asked);
                                                      answer(asked, said);
                                                      ros::encode(said, reply);
                                                  }));
    node.addReader(services_.back()->requests.handle());
    node.addWriter(services_.back()->replies.handle());
}

void ParameterServer::work() {
    Bytes bytes;
    uint64_t sender = 0;
    while (true) {
        {
            std::unique_lock lock(mutex_);
            arrived_.wait(lock, [this] { return has_arrived_ || ends_; });
            if (ends_) return;
            has_arrived_ = false;
        }
        for (const auto& service : services_)
            while (!ends_ && service->requests.take(bytes, sender)) try {
                    if (bytes.size() < encapsulation + identity) continue;
                    const Bytes who(bytes.begin() + encapsulation, bytes.begin() + encapsulation + identity);
                    bytes.erase(bytes.begin() + encapsulation, bytes.begin() + encapsulation + identity);
                    Bytes reply;
                    service->answer(bytes, reply);
                    reply.insert(reply.begin() + encapsulation, who.begin(), who.end());
                    service->replies.write(reply);
                } catch (const std::exception&) {
                    continue;  // not a valid request, or no answer possible: the client's wait times out
                }
    }
}

}  // namespace insonify::dds
