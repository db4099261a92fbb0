#include "components/dds/Node.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>

#include "components/dds/Endpoints.hpp"
#include "components/dds/RawType.hpp"
#include "components/ros/Cdr.hpp"
#include "types/ConfigError.hpp"
#include "types/RosNames.hpp"

namespace insonify::dds {
namespace {

/** Keeps what Cyclone logs instead of printing it. One instance at a time. */
class LoggedErrors {
public:
    LoggedErrors() { dds_set_log_sink(&LoggedErrors::keep, this); }
    ~LoggedErrors() { dds_set_log_sink(nullptr, nullptr); }
    std::string text() const {
        const size_t last = logged_.find_last_not_of(" \n");
        return last == std::string::npos ? "" : ": " + logged_.substr(0, last + 1);
    }

private:
    /** Runs on any thread: other participants log here as well. */
    static void keep(void* to, const dds_log_data_t* data) {
        if (!(data->priority & (DDS_LC_ERROR | DDS_LC_WARNING | DDS_LC_FATAL | DDS_LC_CONFIG))) return;
        auto& logged_errors = *static_cast<LoggedErrors*>(to);
        std::lock_guard lock(logged_errors.mutex_);
        logged_errors.logged_.append(data->message, data->size);
    }
    std::mutex mutex_;
    std::string logged_;
};

Guid guidOf(int32_t entity) {
    dds_guid_t found{};
    dds_get_guid(entity, &found);
    Guid guid{};
    static_assert(sizeof found == sizeof guid);
    std::memcpy(guid.data(), &found, sizeof guid);
    return guid;
}

template <size_t size>
Gid<size> gidOf(const Guid& guid) {
    Gid<size> gid;
    std::copy(guid.begin(), guid.end(), gid.data.begin());
    return gid;
}

template <size_t size>
std::vector<Gid<size>> gidsOf(const std::vector<Guid>& guids) {
    std::vector<Gid<size>> gids;
    for (const Guid& guid : guids) gids.push_back(gidOf<size>(guid));
    return gids;
}

constexpr size_t longest_topic = 255;  ///< With "rt/", as in ROS 2.

/** Returns "/auv" for "/auv/sonar", "/" for "sonar". */
std::string namespaceOf(const std::string& node) {
    const size_t slash = node.rfind('/');
    const std::string words = slash == node.npos ? "" : node.substr(0, slash);
    return words.starts_with('/') ? words : "/" + words;
}

}  // namespace

Entity& Entity::operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
}

Entity::~Entity() {
    if (handle_ > 0) dds_delete(handle_);
}

Entity joinDomain(uint32_t id, std::string_view user_data) {
    static std::mutex one_at_a_time;
    std::lock_guard lock(one_at_a_time);
    const LoggedErrors logged_errors;
    const std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)> qos(dds_create_qos(), dds_delete_qos);
    dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
    const dds_entity_t joined = dds_create_participant(id, qos.get(), nullptr);
    if (joined > 0) return Entity(joined);
    throw types::ConfigError("", "domain",
                             "DDS domain " + std::to_string(id) + " cannot be joined: " + dds_strretcode(joined) +
                                 logged_errors.text() + "; see CYCLONEDDS_URI and ROS_DOMAIN_ID");
}

uint32_t domainId(std::optional<uint32_t> given) {
    if (given) return *given;
    const char* text = std::getenv("ROS_DOMAIN_ID");
    if (!text || !*text) return 0;
    const std::string_view digits(text);
    uint32_t id = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), id);
    if (error != std::errc() || end != digits.data() + digits.size() || id > highest_domain)
        throw types::ConfigError("", "domain",
                                 "ROS_DOMAIN_ID is " + std::string(digits) + "; must be a whole number from 0 to 232");
    return id;
}

std::string ddsTopic(const std::string& ros_topic) {
    return ros_topic.starts_with('/') ? "rt" + ros_topic : "rt/" + ros_topic;
}

std::string ddsType(std::string_view ros_type) {
    std::string name;
    for (const char c : ros_type.substr(0, ros_type.rfind('/'))) name += c == '/' ? "::" : std::string(1, c);
    return name + "::dds_::" + std::string(ros_type.substr(ros_type.rfind('/') + 1)) + "_";
}

std::string rosType(const std::string& dds_type) {
    constexpr std::string_view between = "::msg::dds_::";
    const size_t found = dds_type.find(between);
    if (found == dds_type.npos || !dds_type.ends_with('_')) return dds_type;
    const size_t name = found + between.size();
    return dds_type.substr(0, found) + "/" + dds_type.substr(name, dds_type.size() - name - 1);
}

std::string diagnosticOfTopic(const std::string& name) {
    if (ddsTopic(name).size() > longest_topic)
        return "has " + std::to_string(name.size()) + " characters; at most " + std::to_string(longest_topic - 3) +
               " are a topic's name";
    if (types::isRosName(name)) return "";
    return "is \"" + name + "\"; must be words of letters, digits and _, none beginning with a digit, as /auv/sonar";
}

std::string diagnosticOfNode(const std::string& name) {
    if (types::isRosName(name) && name.size() <= 255) return "";
    return "is \"" + name +
           "\"; must be words of letters, digits and _, none beginning with a digit, as sonar or /auv/sonar";
}

// Without an enclave ROS 2 does not recognise a participant as a node.
Node::Node(uint32_t domain, const std::string& name, size_t gid_size)
    : namespace_(namespaceOf(name)),
      name_(name.substr(name.rfind('/') + 1)),
      gid_size_(gid_size),
      participant_(joinDomain(domain, "enclave=/;")) {}
Node::~Node() = default;

Entity Node::makeTopic(const std::string& dds_topic, const std::string& dds_type, size_t maximum) const {
    ddsi_sertype* type = makeRawType(dds_type, maximum);
    const dds_entity_t topic =
        dds_create_topic_sertype(participant(), dds_topic.c_str(), &type, nullptr, nullptr, nullptr);
    if (topic > 0) return Entity(topic);
    ddsi_sertype_unref(type);
    throw types::ConfigError("", "topics", "topic " + dds_topic + " cannot be made: " + dds_strretcode(topic));
}

std::vector<Published> Node::published() {
    constexpr uint32_t max_writers = 1024;
    if (publications_.handle() <= 0)
        publications_ = Entity(dds_create_reader(participant(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr));
    std::vector<void*> samples(max_writers);
    std::vector<dds_sample_info_t> infos(max_writers);
    const int count = dds_read(publications_.handle(), samples.data(), infos.data(), samples.size(), max_writers);
    std::vector<Published> found;
    dds_guid_t own{};
    dds_get_guid(participant(), &own);
    for (int i = 0; i < count; ++i) {
        const auto& writer = *static_cast<const dds_builtintopic_endpoint_t*>(samples[static_cast<size_t>(i)]);
        const bool is_there =
            infos[static_cast<size_t>(i)].valid_data && infos[static_cast<size_t>(i)].instance_state == DDS_IST_ALIVE;
        if (is_there && std::memcmp(&writer.participant_key, &own, sizeof own) != 0)
            found.push_back({writer.topic_name, writer.type_name});
    }
    if (count > 0) dds_return_loan(publications_.handle(), samples.data(), count);
    return found;
}

void Node::addWriter(int32_t writer) { writers_.push_back(guidOf(writer)); }
void Node::addReader(int32_t reader) { readers_.push_back(guidOf(reader)); }

void Node::announce() { gid_size_ == 16 ? announceWith<16>() : announceWith<24>(); }

template <size_t gid_size>
void Node::announceWith() {
    using Info = ParticipantEntitiesInfo<gid_size>;
    const Quality quality{.reliability = Reliability::Reliable, .depth = 1, .transient_local = true};
    const Info info{gidOf<gid_size>(guidOf(participant())),
                    {{namespace_, name_, gidsOf<gid_size>(readers_), gidsOf<gid_size>(writers_)}}};
    Bytes bytes;
    ros::encode(info, bytes);
    if (!discovery_)
        discovery_ = std::make_unique<Writer>(*this, "ros_discovery_info", Info::type_name, Info::type_hash, quality);
    if (!discovery_->write(bytes)) throw std::runtime_error("the node cannot be announced: " + discovery_->failure());
}

}  // namespace insonify::dds
