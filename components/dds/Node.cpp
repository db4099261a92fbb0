#include "components/dds/Node.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <string>

#include "components/dds/Endpoints.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Schema.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/RosNames.hpp"

namespace insonify::dds {
namespace {

/** A sample in transit, shared by Cyclone's caches. */
struct Serdata : ddsi_serdata {
    explicit Serdata(size_t maximum) : bytes(new char[maximum]), capacity(maximum) {}
    std::unique_ptr<char[]> bytes;  ///< Uninitialised.
    size_t capacity;
    uint32_t size = 0;
};

/** Cyclone's type together with our data. */
struct RawType : ddsi_sertype {
    size_t maximum = 0;  ///< Max message accepted from the network [B].
};

const RawType& own(const ddsi_sertype* type) { return *static_cast<const RawType*>(type); }

/** Reuses samples, so that a steady stream allocates nothing. Thread-safe. */
class Pool {
public:
    /** Returns null if memory is exhausted: no exception may leave through Cyclone, which drops such a sample. */
    Serdata* take(const ddsi_sertype* type, ddsi_serdata_kind kind, size_t size) noexcept try {
        Serdata* data = find(size);
        if (!data) data = new Serdata(size + size / 8 + 64);  // the next message may be slightly longer
        ddsi_serdata_init(data, type, kind);
        data->size = static_cast<uint32_t>(size);
        return data;
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
    void giveBack(Serdata* data) {
        std::unique_ptr<Serdata> mine(data);
        std::lock_guard lock(mutex_);
        if (free_.size() < free_.capacity()) free_.push_back(std::move(mine));
    }

private:
    /** Returns a sample that is large enough but not much too large. It has 3 extra bytes, because the wire is read in
     *  whole words. */
    Serdata* find(size_t size) {
        std::lock_guard lock(mutex_);
        const auto fits = [&](const auto& data) {
            return data->capacity >= size + 3 && data->capacity <= 2 * size + 256;
        };
        const auto found = std::ranges::find_if(free_, fits);
        if (found == free_.end()) return nullptr;
        std::swap(*found, free_.back());
        Serdata* data = free_.back().release();
        free_.pop_back();
        return data;
    }

    std::mutex mutex_;
    std::vector<std::unique_ptr<Serdata>> free_ = [] {
        std::vector<std::unique_ptr<Serdata>> room;
        room.reserve(24);
        return room;
    }();
};

/** Outlives Cyclone's threads. */
Pool& pool() {
    static Pool* const one = new Pool;
    return *one;
}

const Serdata& own(const ddsi_serdata* data) { return *static_cast<const Serdata*>(data); }

Serdata* makeCopy(const ddsi_sertype* type, ddsi_serdata_kind kind, const char* bytes, size_t size) {
    Serdata* data = pool().take(type, kind, (size + 3) / 4 * 4);
    if (!data) return nullptr;
    if (size > 0) std::memcpy(data->bytes.get(), bytes, size);
    std::memset(data->bytes.get() + size, 0, data->size - size);
    return data;
}

ddsi_serdata* fromFragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* chain, size_t size) {
    if (size > own(type).maximum) return makeCopy(type, kind, nullptr, 0);
    Serdata* data = pool().take(type, kind, size);
    if (!data) return nullptr;
    uint32_t filled = 0;
    for (; chain; chain = chain->nextfrag) {
        if (chain->maxp1 <= filled || chain->min > filled || chain->maxp1 > size) continue;
        const auto* payload = NN_RMSG_PAYLOADOFF(chain->rmsg, NN_RDATA_PAYLOAD_OFF(chain));
        std::memcpy(data->bytes.get() + filled, payload + (filled - chain->min), chain->maxp1 - filled);
        filled = chain->maxp1;
    }
    if (filled == size) return data;
    pool().giveBack(data);
    return nullptr;
}

ddsi_serdata* fromPieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* pieces, size_t size) {
    if (size > own(type).maximum) return makeCopy(type, kind, nullptr, 0);
    Serdata* data = pool().take(type, kind, size);
    if (!data) return nullptr;
    size_t filled = 0;
    for (ddsrt_msg_iovlen_t i = 0; i < count && filled < size; ++i) {
        const size_t part = std::min<size_t>(pieces[i].iov_len, size - filled);
        std::memcpy(data->bytes.get() + filled, pieces[i].iov_base, part);
        filled += part;
    }
    return filled == size ? data : (pool().giveBack(data), nullptr);
}

ddsi_serdata* fromSample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
    const Bytes& bytes = *static_cast<const Bytes*>(sample);
    return makeCopy(type, kind, bytes.data(), kind == SDK_DATA ? bytes.size() : 0);
}

bool toSample(const ddsi_serdata* data, void* sample, void**, void*) noexcept try {
    static_cast<Bytes*>(sample)->assign(own(data).bytes.get(), own(data).bytes.get() + own(data).size);
    return true;
} catch (const std::bad_alloc&) {
    return false;
}

void copyOut(const ddsi_serdata* data, size_t offset, size_t size, void* to) {
    std::memcpy(to, own(data).bytes.get() + offset, size);
}

ddsi_serdata* refer(const ddsi_serdata* data, size_t offset, size_t size, ddsrt_iovec_t* piece) {
    piece->iov_base = own(data).bytes.get() + offset;
    piece->iov_len = size;
    return ddsi_serdata_ref(data);
}

// Without a key, all samples belong to one instance without content.
ddsi_serdata* untyped(const ddsi_sertype* type) { return makeCopy(type, SDK_KEY, nullptr, 0); }

const ddsi_serdata_ops data_operations = {
    .eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; },
    .get_size = [](const ddsi_serdata* data) { return own(data).size; },
    .from_ser = fromFragments,
    .from_ser_iov = fromPieces,
    .from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) { return untyped(type); },
    .from_sample = fromSample,
    .to_ser = copyOut,
    .to_ser_ref = refer,
    .to_ser_unref = [](ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); },
    .to_sample = toSample,
    .to_untyped = [](const ddsi_serdata* data) { return untyped(data->type); },
    .untyped_to_sample =
        [](const ddsi_sertype*, const ddsi_serdata*, void* sample, void**, void*) {
            static_cast<Bytes*>(sample)->clear();
            return true;
        },
    .free = [](ddsi_serdata* data) { pool().giveBack(static_cast<Serdata*>(data)); },
    .print = [](const ddsi_sertype*, const ddsi_serdata*, char* text, size_t size) -> size_t {
        if (size > 0) text[0] = 0;
        return 0;
    },
    .get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash, bool) { *hash = {}; },
    .get_sample_size = nullptr,  // shared memory is not used
    .from_iox_buffer = nullptr,
};

// Samples are the caller's vectors; Cyclone never lends its own.
const ddsi_sertype_ops type_operations = {
    .version = ddsi_sertype_v0,
    .arg = nullptr,
    .free =
        [](ddsi_sertype* type) {
            ddsi_sertype_fini(type);
            delete static_cast<RawType*>(type);
        },
    .zero_samples = [](const ddsi_sertype*, void*, size_t) {},
    .realloc_samples = [](void**, const ddsi_sertype*, void*, size_t, size_t) { std::abort(); },
    .free_samples = [](const ddsi_sertype*, void**, size_t, dds_free_op_t) {},
    .equal = [](const ddsi_sertype* a, const ddsi_sertype* b) { return own(a).maximum == own(b).maximum; },
    .hash = [](const ddsi_sertype*) { return uint32_t{0}; },
    .type_id = nullptr,
    .type_map = nullptr,
    .type_info = nullptr,
    .derive_sertype = nullptr,
    .get_serialized_size = nullptr,
    .serialize_into = nullptr,
};

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

Guid makeGuid(int32_t entity) {
    dds_guid_t found{};
    dds_get_guid(entity, &found);
    Guid guid{};
    static_assert(sizeof found == sizeof guid);
    std::memcpy(guid.data(), &found, sizeof guid);
    return guid;
}

template <size_t size>
Gid<size> toGid(const Guid& guid) {
    Gid<size> gid;
    std::copy(guid.begin(), guid.end(), gid.data.begin());
    return gid;
}

template <size_t size>
std::vector<Gid<size>> toGids(const std::vector<Guid>& guids) {
    std::vector<Gid<size>> gids;
    for (const Guid& guid : guids) gids.push_back(toGid<size>(guid));
    return gids;
}

constexpr size_t longest_topic = 255;  ///< With "rt/", as in ROS 2.

/** Returns "/auv" for "/auv/sonar", "/" for "sonar". */
std::string getNamespace(const std::string& node) {
    const size_t slash = node.rfind('/');
    const std::string words = slash == node.npos ? "" : node.substr(0, slash);
    return words.starts_with('/') ? words : "/" + words;
}

}  // namespace

ddsi_sertype* makeRawType(const std::string& type_name, size_t maximum) {
    auto type = std::make_unique<RawType>();
    ddsi_sertype_init(type.get(), type_name.c_str(), &type_operations, &data_operations, true);
    type->maximum = maximum;
    return type.release();
}

Entity& Entity::operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
}

Entity::~Entity() {
    if (handle_ > 0) dds_delete(handle_);
}

std::string discoverySettings() {
    const auto given = [](const char* name) {
        const char* const text = std::getenv(name);
        return std::string(text ? text : "");
    };
    const bool localhost_only = given("ROS_LOCALHOST_ONLY") == "1";
    const std::string wanted = given("ROS_AUTOMATIC_DISCOVERY_RANGE"), peers = given("ROS_STATIC_PEERS");
    const std::string range = localhost_only ? "LOCALHOST" : wanted.empty() ? "SUBNET" : wanted;
    if (range != "SUBNET" && range != "LOCALHOST" && range != "OFF" && range != "SYSTEM_DEFAULT")
        throw types::ConfigError(
            "", "domain",
            "ROS_AUTOMATIC_DISCOVERY_RANGE is " + range + "; must be SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT");
    if (peers.find_first_of("<>&\"'") != std::string::npos)
        throw types::ConfigError("", "domain",
                                 "ROS_STATIC_PEERS is " + peers + "; must be addresses with ; between them");
    const bool is_local = range == "LOCALHOST", takes_peers = !localhost_only && (is_local || range == "SUBNET");
    std::string listed = is_local ? "<Peer address=\"localhost\"/>" : "";
    for (size_t at = 0; takes_peers && at < peers.size(); at = std::min(peers.find(';', at), peers.size()) + 1)
        if (const std::string peer = peers.substr(at, peers.find(';', at) - at); !peer.empty())
            listed += "<Peer address=\"" + peer + "\"/>";
    if (range == "SYSTEM_DEFAULT" || (range == "SUBNET" && listed.empty())) return "";
    const std::string general = range == "SUBNET" ? "" : "<General><AllowMulticast>false</AllowMulticast></General>";
    const std::string discovery =
        range == "OFF"
            ? "<ParticipantIndex>none</ParticipantIndex><Tag>ros_discovery_off_" + std::to_string(getpid()) + "</Tag>"
            : "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</"
              "MaxAutoParticipantIndex><Peers>" +
                  listed + "</Peers>";
    return "<CycloneDDS><Domain>" + general + "<Discovery>" + discovery + "</Discovery></Domain></CycloneDDS>";
}

namespace {

/** Returns the domain with the settings of discovery, which its participants keep; null where Cyclone makes it by
 *  itself. Under the mutex of joinDomain(). */
std::shared_ptr<Entity> madeDomain(uint32_t id, const LoggedErrors& logged_errors) {
    static std::map<uint32_t, std::weak_ptr<Entity>> made;
    if (const auto known = made[id].lock()) return known;
    std::string settings = discoverySettings();
    if (settings.empty()) return nullptr;
    if (const char* const more = std::getenv("CYCLONEDDS_URI"); more && *more) settings += std::string(",") + more;
    const dds_entity_t domain = dds_create_domain(id, settings.c_str());
    if (domain <= 0)
        throw types::ConfigError("", "domain",
                                 "DDS domain " + std::to_string(id) + " cannot be set up: " + dds_strretcode(domain) +
                                     logged_errors.text() + "; see ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_STATIC_PEERS " +
                                     "and CYCLONEDDS_URI");
    const auto shared = std::make_shared<Entity>(domain);
    made[id] = shared;
    return shared;
}

}  // namespace

Participant joinDomain(uint32_t id, std::string_view user_data) {
    static std::mutex one_at_a_time;
    std::lock_guard lock(one_at_a_time);
    const LoggedErrors logged_errors;
    Participant participant;
    participant.domain = madeDomain(id, logged_errors);
    const std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)> qos(dds_create_qos(), dds_delete_qos);
    dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
    const dds_entity_t joined = dds_create_participant(id, qos.get(), nullptr);
    participant.entity = Entity(joined);
    if (joined > 0) return participant;
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
    if (types::isRosName(name.starts_with("~/") ? std::string_view(name).substr(2) : name)) return "";
    return "is \"" + name +
           "\"; must be words of letters, digits and _, none beginning with a digit, as /auv/sonar or ~/sonar";
}

std::string diagnosticOfNode(const std::string& name) {
    if (types::isRosName(name) && name.size() <= 255) return "";
    return "is \"" + name +
           "\"; must be words of letters, digits and _, none beginning with a digit, as sonar or /auv/sonar";
}

// Without an enclave ROS 2 does not recognise a participant as a node.
Node::Node(uint32_t domain, const std::string& name, size_t gid_size)
    : namespace_(getNamespace(name)),
      name_(name.substr(name.rfind('/') + 1)),
      gid_size_(gid_size),
      participant_(joinDomain(domain, "enclave=/;")) {}
Node::~Node() = default;

Guid Node::guid() const { return makeGuid(participant()); }

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

void Node::addWriter(int32_t writer) { writers_.push_back(makeGuid(writer)); }
void Node::addReader(int32_t reader) { readers_.push_back(makeGuid(reader)); }

void Node::announce() { gid_size_ == 16 ? announceWith<16>() : announceWith<24>(); }

template <size_t gid_size>
void Node::announceWith() {
    using Info = ParticipantEntitiesInfo<gid_size>;
    const Quality quality{.reliability = Reliability::Reliable, .depth = 1, .transient_local = true};
    const Info info{toGid<gid_size>(makeGuid(participant())),
                    {{namespace_, name_, toGids<gid_size>(readers_), toGids<gid_size>(writers_)}}};
    Bytes bytes;
    ros::encode(info, bytes);
    if (!discovery_)
        discovery_ =
            std::make_unique<Writer>(*this, "ros_discovery_info", Info::type_name, ros::typeHash<Info>(), quality);
    if (!discovery_->write(bytes)) throw std::runtime_error("the node cannot be announced: " + discovery_->failure());
}

}  // namespace insonify::dds
