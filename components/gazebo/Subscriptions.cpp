#include "components/gazebo/Subscriptions.hpp"

#include <gazebo_messages.pb.h>  // made by the build, of messages.proto

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <zmq.hpp>
#include <zmq_addon.hpp>

#include "components/gazebo/Discovery.hpp"
#include "components/gazebo/Multicast.hpp"
#include "components/gazebo/World.hpp"
#include "types/Thread.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::gazebo {
namespace {

glm::dvec3 toVector(const wire::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/** A message omits the identity orientation. */
Place placeIn(const wire::Pose& message) {
    const wire::Quaternion& q = message.orientation();
    return {toVector(message.position()),
            message.has_orientation() ? glm::dquat(q.w(), q.x(), q.y(), q.z()) : glm::dquat(1, 0, 0, 0)};
}

types::Pose getPose(const Place& place, const types::Axes& axes) {
    types::Pose pose;
    pose.position = axes.rockFromWorld(place.position);
    pose.orientation = axes.rockFromOrientation(place.orientation);
    return pose;
}

std::optional<types::Time> getStamp(const wire::Header& header) {
    constexpr int64_t latest = int64_t{1} << 40;  // [s]; more than 34,000 years
    if (!header.has_stamp()) return {};
    const int64_t seconds = header.stamp().sec();
    if (seconds < -latest || seconds > latest) return {};
    return types::Time{seconds * 1'000'000 + header.stamp().nsec() / 1000};
}

bool parse(std::string_view bytes, auto& message) {
    return bytes.size() < size_t{1} << 31 && message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

using WorkerClock = std::chrono::steady_clock;
constexpr int64_t max_message = int64_t{256} << 20;  // [bytes]
constexpr int max_burst = 200;                       ///< Max messages that are read before datagrams of discovery.
constexpr std::chrono::milliseconds period{1000};    ///< Between two heartbeats, the same for all programs.

/** Returns the last two parts of a topic, such as "/pose/info". */
std::string ending(const std::string& topic) {
    const size_t last = topic.rfind('/');
    const size_t before = last == std::string::npos || last == 0 ? last : topic.rfind('/', last - 1);
    return before == std::string::npos ? topic : topic.substr(before);
}

/** Returns the entry for a message that is damaged or has a wrong type. */
Arrived unread(size_t topic, const std::string& type, const std::string& wanted) {
    return {topic,
            {},
            {},
            {},
            type == wanted ? "bytes that are no " + wanted : "messages of type " + type + ", not " + wanted};
}

}  // namespace

std::optional<PoseMessage> readPoses(std::string_view bytes, types::WorldFrame frame) {
    wire::PoseV message;
    if (!parse(bytes, message)) return {};
    const types::Axes axes{frame};
    PoseMessage read{getStamp(message.header()), {}};
    for (const wire::Pose& pose : message.pose())
        read.entities.push_back({pose.name(), getPose(placeIn(pose), axes), pose.id(), placeIn(pose)});
    return read;
}

std::optional<OdometryMessage> readOdometry(std::string_view bytes, types::WorldFrame frame) {
    wire::Odometry message;
    if (!parse(bytes, message)) return {};
    const types::Axes axes{frame};
    OdometryMessage read{getStamp(message.header()), getPose(placeIn(message.pose()), axes)};
    types::Pose& pose = read.pose;
    if (!message.has_twist() || !types::isUsable(pose)) return read;
    pose.velocity = glm::normalize(pose.orientation) * axes.body(toVector(message.twist().linear()));
    pose.angular_velocity = axes.body(toVector(message.twist().angular()));
    return read;
}

FoundEntity findEntity(const PoseMessage& message, const std::string& name) {
    FoundEntity found;
    int count = 0;
    for (const PoseMessage::Entity& entity : message.entities)
        if (entity.name == name) {
            found.pose = &entity.pose;
            ++count;
        }
    if (count == 1) return found;
    if (count == 0) return {nullptr, "no entity of that name"};
    return {nullptr, "several entities of that name; those inside models have poses in their parents' frames"};
}

types::Pose poseOfChain(const PoseMessage& message, Chain& chain, types::WorldFrame frame) {
    Place whole;
    for (Chain::Part& part : chain.parts) {
        const auto moved = std::ranges::find(message.entities, part.id, &PoseMessage::Entity::id);
        if (moved != message.entities.end()) part.place = moved->place;
        whole.position += glm::normalize(whole.orientation) * part.place.position;
        whole.orientation = whole.orientation * part.place.orientation;
    }
    return getPose(whole, types::Axes{frame});
}

namespace {

void addChains(const wire::Model& model, const std::string& scope, const Chain& parents,
               std::map<std::string, Chain>& chains) {
    const auto longer = [](Chain chain, const auto& entity) {
        chain.parts.push_back({entity.id(), placeIn(entity.pose())});
        return chain;
    };
    const Chain own = longer(parents, model);
    const std::string inner = scope + model.name() + "::";
    chains.emplace(scope + model.name(), own);
    for (const wire::Link& link : model.link()) chains.emplace(inner + link.name(), longer(own, link));
    for (const wire::Model& nested : model.model()) addChains(nested, inner, own, chains);
}

std::mutex stamps_mutex;

/** Returns the stamps of a world's last poses by their time on our clock. */
std::map<types::Time, types::Time>& stampsIn(const std::string& world, const std::string& partition) {
    static std::map<std::string, std::map<types::Time, types::Time>> worlds;
    return worlds[partition + "@" + world];
}

}  // namespace

std::map<std::string, Chain> readChains(std::string_view bytes) {
    wire::Scene scene;
    if (!parse(bytes, scene))
        throw types::ConfigError("", "world", "has a service that answers bytes which are no message Scene");
    std::map<std::string, Chain> chains;
    for (const wire::Model& model : scene.model()) addChains(model, "", {}, chains);
    return chains;
}

void noteStamp(const std::string& world, const std::string& partition, types::Time time, types::Time stamp) {
    constexpr size_t kept = 4000;  // a minute of Gazebo's poses
    const std::lock_guard lock(stamps_mutex);
    std::map<types::Time, types::Time>& stamps = stampsIn(world, partition);
    stamps.erase(stamps.lower_bound(time), stamps.end());  // after our clock went back
    stamps.emplace_hint(stamps.end(), time, stamp);
    if (stamps.size() > kept) stamps.erase(stamps.begin());
}

std::optional<types::Time> findStamp(const std::string& world, const std::string& partition, types::Time time) {
    const std::lock_guard lock(stamps_mutex);
    const std::map<types::Time, types::Time>& stamps = stampsIn(world, partition);
    if (stamps.empty()) return {};
    const auto after = stamps.upper_bound(time);
    if (after == stamps.begin()) return after->second - (after->first - time);
    const auto& [begin, stamp] = *std::prev(after);
    const types::Time passed = time - begin;
    if (after == stamps.end() || after->second <= stamp)
        return stamp + passed;  // the newest, or the last before a reset
    const double rate = (after->second - stamp).seconds() / (after->first - begin).seconds();
    return stamp + types::Time::fromSeconds(passed.seconds() * rate);
}

class Subscriber::Worker {
public:
    Worker(const TransportOptions& options, std::vector<Topic> topics)
        : topics_(std::move(topics)),
          multicast_(options, options.topic_port),
          has_publisher_(topics_.size()),
          received_(topics_.empty() ? "" : ending(topics_[0].name)) {
        socket_.set(zmq::sockopt::linger, 0);
        socket_.set(zmq::sockopt::maxmsgsize, max_message);
        for (size_t i = 0; i < topics_.size(); ++i) {
            const auto name = qualifiedName(options.partition, topics_[i].name);
            if (!name) throw types::ConfigError("", std::to_string(i), "is no name of a topic");
            names_.push_back(*name);
            socket_.set(zmq::sockopt::subscribe, *name);
        }
        thread_ = types::startThread("the topics of Gazebo", [this] { run(); });
    }
    ~Worker() {
        stop_.raise();
        thread_.join();
    }

    bool hasPublisher(size_t topic) const { return has_publisher_[topic]; }
    std::string received() const {
        const std::lock_guard lock(mutex_);
        return received_.text();
    }

private:
    void run() {
        auto next = WorkerClock::now();
        for (bool continues = true; continues;) {
            const auto wait = std::chrono::ceil<std::chrono::milliseconds>(next - WorkerClock::now());
            zmq::pollitem_t items[] = {{socket_.handle(), 0, ZMQ_POLLIN, 0},
                                       {nullptr, multicast_.descriptor(), ZMQ_POLLIN, 0},
                                       {nullptr, stop_.descriptor(), ZMQ_POLLIN, 0}};
            try {
                zmq::poll(items, std::size(items), std::max(wait, std::chrono::milliseconds{0}));
                continues = !items[2].revents;
                if (items[0].revents) readMessages();
                if (items[1].revents) readDatagrams();
                if (WorkerClock::now() < next) continue;
                next = WorkerClock::now() + period;
                announce();
            } catch (const std::exception&) {
                continue;  // a signal, or a message that is too large for the memory: lost
            }
        }
        for (const auto& [address, publication] : publications_) connect(publication, false);
        multicast_.send(goodbyeDatagram(process_));
    }

    /** Sends a heartbeat and the topics without a publisher. Forgets publishers that are silent. */
    void announce() {
        multicast_.send(aliveDatagram(process_));
        for (size_t i = 0; i < names_.size(); ++i)
            if (!has_publisher_[i]) multicast_.send(askDatagram(process_, names_[i]));
        const auto oldest = WorkerClock::now() - std::chrono::duration<double>(silence_s);
        for (auto each = last_received_.begin(); each != last_received_.end();) {
            const auto [process, time] = *each++;
            if (time < oldest) forget(process, "");
        }
    }

    void readMessages() {
        for (int i = 0; i < max_burst; ++i) {
            std::vector<zmq::message_t> frames;
            if (!zmq::recv_multipart(socket_, std::back_inserter(frames), zmq::recv_flags::dontwait)) return;
            if (frames.size() < 4) continue;  // topic, sender's address, message, type
            const auto name = std::ranges::find(names_, frames[0].to_string_view());
            if (name == names_.end()) continue;  // a topic that only begins with the name
            const Topic& topic = topics_[static_cast<size_t>(name - names_.begin())];
            topic.use(messageName(frames[3].to_string()), frames[2].to_string_view());
        }
    }

    void readDatagrams() {
        while (const auto datagram = multicast_.receive()) {
            std::optional<Announcement> news;
            {
                const std::lock_guard lock(mutex_);
                news = readDatagram(datagram->bytes, process_, received_);
            }
            if (!news) continue;
            const Publication& publication = news->publication;
            switch (news->kind) {
                case Announcement::Kind::Offer:
                    if (!publication.is_for_host || datagram->is_from_here) follow(publication);
                    break;
                case Announcement::Kind::Withdrawal: forget(news->process, publication.topic); break;
                case Announcement::Kind::Goodbye: forget(news->process, ""); break;
                case Announcement::Kind::Question:
                case Announcement::Kind::Alive: break;
            }
            if (const auto known = last_received_.find(news->process); known != last_received_.end())
                known->second = WorkerClock::now();
        }
    }

    /** Requests the messages of a publication, or ends the request. Repeated with each offer, because a datagram may be
     *  lost and a publisher sends only to programs that have asked. */
    void connect(const Publication& publication, bool begins) const {
        multicast_.send(connectionDatagram(process_, node_, publication, begins));
    }

    void follow(const Publication& publication) {
        if (publication.is_service || std::ranges::count(names_, publication.topic) == 0) return;
        if (!publications_.contains({publication.address, publication.topic})) {
            try {
                if (!isConnected(publication.address)) socket_.connect(publication.address);
            } catch (const zmq::error_t&) {
                return;  // invalid address
            }
            publications_[{publication.address, publication.topic}] = publication;
            last_received_[publication.process] = WorkerClock::now();
            countPublishers();
        }
        connect(publication, true);
    }

    bool isConnected(const std::string& address) const {
        return std::ranges::any_of(publications_, [&](const auto& each) { return each.first.address == address; });
    }

    /** Removes the publication of a topic; an empty topic means all topics of the process. */
    void forget(const std::string& process, const std::string& topic) {
        for (auto each = publications_.begin(); each != publications_.end();) {
            const auto [key, publication] = *each;
            if (publication.process != process || (!topic.empty() && publication.topic != topic)) {
                ++each;
                continue;
            }
            each = publications_.erase(each);
            if (!isConnected(key.address)) zmq_disconnect(socket_.handle(), key.address.c_str());
        }
        if (topic.empty()) last_received_.erase(process);
        countPublishers();
    }

    void countPublishers() {
        for (size_t i = 0; i < names_.size(); ++i)
            has_publisher_[i] =
                std::ranges::any_of(publications_, [&](const auto& each) { return each.first.topic == names_[i]; });
    }

    struct Key {
        std::string address, topic;
        auto operator<=>(const Key&) const = default;
    };

    const std::vector<Topic> topics_;
    std::vector<std::string> names_;  ///< Topics, with the partition.
    const std::string process_ = makeUuid(), node_ = makeUuid();
    Multicast multicast_;
    zmq::context_t context_;
    zmq::socket_t socket_{context_, zmq::socket_type::sub};
    std::map<Key, Publication> publications_;                       ///< Publications that are received.
    std::map<std::string, WorkerClock::time_point> last_received_;  ///< Time of the last datagram of their processes.
    const Alarm stop_;                                              ///< Becomes readable when the thread shall end.
    std::vector<std::atomic<bool>> has_publisher_;                  ///< For each topic.
    mutable std::mutex mutex_;
    Received received_;
    std::thread thread_;
};

Subscriber::Subscriber(const TransportOptions& options, std::vector<Topic> topics)
    : worker_(std::make_unique<Worker>(options, std::move(topics))) {}
Subscriber::~Subscriber() = default;
bool Subscriber::hasPublisher(size_t topic) const { return worker_->hasPublisher(topic); }
std::string Subscriber::received() const { return worker_->received(); }

WorldWatch::Change WorldWatch::take(const PoseMessage& message) {
    const auto isSame = [](const std::string& name, const PoseMessage::Entity& entity) { return name == entity.name; };
    if (std::ranges::equal(last_names_, message.entities, isSame)) return {};
    last_names_.clear();
    for (const PoseMessage::Entity& entity : message.entities) last_names_.push_back(entity.name);
    std::set<std::string> now(last_names_.begin(), last_names_.end());
    if (!std::exchange(is_taken_, true)) known_ = now;
    Change change;
    for (const std::string& name : now)
        if (!known_.contains(name) && reported_.insert(name).second) change.came.push_back(name);
    for (const std::string& name : present_)
        if (!now.contains(name) && known_.contains(name) && reported_.insert(name).second) change.went.push_back(name);
    if (reported_.size() > max_reported)
        std::erase_if(reported_, [&](const std::string& name) { return !now.contains(name); });
    present_ = std::move(now);
    return change;
}

void Inbox::put(Arrived message) {
    {
        const std::lock_guard lock(mutex_);
        if (messages_.size() >= capacity) {
            messages_.erase(messages_.begin());
            ++lost_;
        }
        messages_.push_back(std::move(message));
    }
    arrived_();
}

std::vector<Arrived> Inbox::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

uint64_t Inbox::lost() const {
    const std::lock_guard lock(mutex_);
    return lost_;
}

namespace {

/** Returns the pose of a body by the numbers of its chain. A model that was removed and inserted again has another
 *  number, and is found by its name. */
Placed placeBody(const PoseMessage& message, size_t body, const std::string& entity, std::optional<Chain>& chain,
                 types::WorldFrame frame) {
    const bool is_known = chain && (chain->parts.size() > 1 || std::ranges::count(message.entities, chain->parts[0].id,
                                                                                  &PoseMessage::Entity::id) > 0);
    auto [pose, diagnostic] = is_known ? FoundEntity{} : findEntity(message, entity);
    if (pose) return {body, *pose, ""};
    if (chain) return {body, poseOfChain(message, *chain, frame), ""};
    return {body, {}, std::move(diagnostic)};
}

}  // namespace

Subscriptions::Subscriptions(const PoseConfig& config, Inbox& inbox)
    : options_(TransportOptions::fromEnvironment(config.partition)) {
    std::vector<Topic> topics;
    if (std::ranges::any_of(config.bodies, [](const BodyConfig& body) { return !body.entity.empty(); }))
        topics.push_back(entities(config, inbox));
    for (size_t i = 0; i < config.bodies.size(); ++i)
        if (!config.bodies[i].odometry.empty()) topics.push_back(odometry(config, i, inbox));
    for (size_t i = 0; i < topics_.size(); ++i)
        if (!qualifiedName(options_.partition, topics_[i]))
            throw types::ConfigError("", keys_[i],
                                     "is " + topics_[i] + ", which Gazebo's transport does not take for a topic");
    subscriber_ = std::make_unique<Subscriber>(options_, std::move(topics));
}

Topic Subscriptions::entities(const PoseConfig& config, Inbox& inbox) {
    const size_t number = topics_.size();
    topics_.push_back(config.poseTopic());
    keys_.push_back(config.pose_topic.empty() ? "world" : "pose_topic");
    struct State {
        std::vector<BodyConfig> bodies;
        types::WorldFrame frame;
        std::string world;  ///< Empty when the topic is not that of a whole world.
        std::string partition;
        std::vector<std::optional<Chain>> chains;  ///< By body.
        std::optional<WorldWatch> watch;
    };
    const auto state = std::make_shared<State>(State{config.bodies,
                                                     config.world_frame,
                                                     config.pose_topic.empty() ? config.world : "",
                                                     options_.partition,
                                                     chains(config),
                                                     {}});
    return {topics_.back(), [&inbox, number, state](const std::string& type, std::string_view bytes) {
                const auto message = type == "Pose_V" ? readPoses(bytes, state->frame) : std::nullopt;
                if (!message) return inbox.put(unread(number, type, "Pose_V"));
                Arrived arrived{number, message->stamp, {}, {}, ""};
                for (size_t i = 0; i < state->bodies.size(); ++i) {
                    if (state->bodies[i].entity.empty()) continue;
                    arrived.bodies.push_back(
                        placeBody(*message, i, state->bodies[i].entity, state->chains[i], state->frame));
                }
                if (!state->world.empty()) {
                    if (!state->watch) state->watch.emplace(namesTaken(state->world, state->partition));
                    arrived.change = state->watch->take(*message);
                }
                inbox.put(std::move(arrived));
            }};
}

std::vector<std::optional<Chain>> Subscriptions::chains(const PoseConfig& config) const {
    const auto isScope = [](const BodyConfig& body) { return body.entity.find("::") != std::string::npos; };
    std::vector<std::optional<Chain>> found(config.bodies.size());
    if (std::ranges::none_of(config.bodies, isScope)) return found;
    const std::string service = "/world/" + config.world + "/scene/info";
    const Reply reply =
        request(options_, {service, "Empty", "Scene"}, "", std::chrono::duration<double>(config.timeout));
    if (!reply.failure.empty())
        throw types::ConfigError("", "world", "is " + config.world + "; its service " + service + " " + reply.failure);
    const std::map<std::string, Chain> all = readChains(reply.message);
    std::vector<std::string> names;
    for (const auto& [name, chain] : all) names.push_back(name);
    for (size_t i = 0; i < config.bodies.size(); ++i) {
        const auto known = all.find(config.bodies[i].entity);
        if (!isScope(config.bodies[i])) {
            if (known != all.end() && known->second.parts[0].id != 0) found[i] = known->second;
            continue;
        }
        if (known == all.end()) {
            const std::string near = types::didYouMean(config.bodies[i].entity, names);
            throw types::ConfigError("", "bodies[" + std::to_string(i) + "].entity",
                                     "is " + config.bodies[i].entity + ", which world " + config.world +
                                         " does not have" + (near.empty() ? "" : "; " + near));
        }
        found[i] = known->second;
    }
    return found;
}

Topic Subscriptions::odometry(const PoseConfig& config, size_t body, Inbox& inbox) {
    const size_t number = topics_.size();
    topics_.push_back(config.bodies[body].odometry);
    keys_.push_back("bodies[" + std::to_string(body) + "].odometry");
    return {topics_.back(),
            [&inbox, number, body, frame = config.world_frame](const std::string& type, std::string_view bytes) {
                const auto message = type == "Odometry" ? readOdometry(bytes, frame) : std::nullopt;
                if (!message) return inbox.put(unread(number, type, "Odometry"));
                inbox.put({number, message->stamp, {{body, message->pose, ""}}, {}, ""});
            }};
}

}  // namespace insonify::gazebo
