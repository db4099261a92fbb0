#include "components/gazebo/TransportOptions.hpp"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <random>

#include "types/text/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

/** Returns the value of a GZ_ variable (Garden and later), or of the IGN_ variable (Fortress) when that is not set. */
std::optional<std::string> variable(const std::string& name) {
    for (const char* prefix : {"GZ_", "IGN_"})
        if (const char* const value = std::getenv((prefix + name).c_str())) return value;
    return {};
}

uint16_t getPort(const std::string& name, uint16_t otherwise) {
    const std::optional<std::string> text = variable(name);
    if (!text || text->empty()) return otherwise;
    uint16_t port = 0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), port);
    if (error != std::errc() || end != text->data() + text->size() || port == 0)
        throw types::ConfigError("", "",
                                 fmt::format("the environment variable GZ_{} or IGN_{} is \"{}\"; must be a "
                                             "port, 1 to 65535",
                                             name, name, *text));
    return port;
}

std::string hostAndUser() {
    char host[256] = {}, buffer[4096];
    if (gethostname(host, sizeof host - 1) != 0) host[0] = 0;
    passwd entry{}, *found = nullptr;
    const bool is_known = getpwuid_r(getuid(), &entry, buffer, sizeof buffer, &found) == 0 && found;
    return std::string(host) + ":" + (is_known ? found->pw_name : "");
}

bool isTaken(const std::string& name) {
    return name != "/" && name.find_first_of("~@ \t\n") == std::string::npos && name.find("//") == std::string::npos &&
           name.size() < 65536;
}

}  // namespace

TransportOptions TransportOptions::fromEnvironment(const std::string& partition) {
    TransportOptions options;
    options.partition = partition.empty() ? variable("PARTITION").value_or(hostAndUser()) : partition;
    if (!isTaken(options.partition))
        throw types::ConfigError("", "partition",
                                 "is " + options.partition + ", which Gazebo's transport does not take");
    options.ip = variable("IP").value_or("");
    if (const auto group = variable("DISCOVERY_MULTICAST_IP"); group && !group->empty()) options.group = *group;
    options.topic_port = getPort("DISCOVERY_MSG_PORT", options.topic_port);
    options.service_port = getPort("DISCOVERY_SRV_PORT", options.service_port);
    return options;
}

std::optional<std::string> qualifiedName(const std::string& partition, const std::string& topic) {
    if (topic.empty() || !isTaken(topic) || !isTaken(partition)) return {};
    std::string scope = partition;
    if (!scope.empty() && scope.front() != '/') scope.insert(0, 1, '/');
    if (scope.ends_with('/')) scope.pop_back();
    std::string name = topic.front() == '/' ? topic : "/" + topic;
    if (name.ends_with('/')) name.pop_back();
    return "@" + scope + "@" + name;
}

std::optional<TopicName> TopicName::of(const std::string& qualified) {
    const size_t end = qualified.find('@', 1);
    if (!qualified.starts_with('@') || end == std::string::npos || end + 1 == qualified.size()) return {};
    const size_t begin = qualified[1] == '/' ? 2 : 1;
    return TopicName{qualified.substr(begin, end - std::min(begin, end)), qualified.substr(end + 1)};
}

std::string messageName(const std::string& type) {
    for (const std::string_view scope : {"gz.msgs.", "ignition.msgs."})
        if (type.starts_with(scope)) return type.substr(scope.size());
    return type;
}

std::string makeUuid() {
    std::random_device random;
    std::string uuid;
    for (int i = 0; i < 4; ++i) uuid += fmt::format("{:08x}", random());
    for (const size_t dash : {20, 16, 12, 8}) uuid.insert(dash, 1, '-');
    return uuid;
}

}  // namespace insonify::gazebo
