#include "components/dds/PublisherTask.hpp"

#include <algorithm>
#include <chrono>

#include "components/dds/SubscriberTask.hpp"
#include "components/dds/TransformTask.hpp"
#include "components/framework/Deployment.hpp"
#include "components/framework/Graph.hpp"
#include "components/framework/execution/Timing.hpp"
#include "components/ros/Poses.hpp"
#include "components/ros/Schema.hpp"
#include "components/ros/Stamps.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::dds {
namespace {

void reportLatency(framework::TaskContext& task, const auto& sample) {
    if constexpr (requires { sample.time; }) framework::noteLatency(task, sample.time);
}

/** Returns why an input's samples cannot become the topic's messages; empty if they can. */
template <class Input>
std::string whyNot(const Input& input, const TopicOut& topic) {
    using Sample = typename Input::Sample;
    if (canBe<Sample>(topic.type)) return "";
    const std::string type(types::EnumNames<MessageType>::names[static_cast<size_t>(topic.type)]);
    return "is " + type + "; " + input.port.typeName() + " can be " + getMessages<Sample>();
}

/** Sends a sample to all topics of its input. */
template <class Input>
void send(Input& input, const typename Input::Carried& sample, framework::TaskContext& task) {
    const auto* const content = types::carriedSample(sample);
    for (const auto& publication : input.kept.publications)
        if (publication->publish(*content)) reportLatency(task, *content);
}

}  // namespace

framework::InputPortBase* PublisherTask::makeInput(const std::string& port, framework::OutputPortBase& source) {
    listenToWarnings();
    if (std::ranges::none_of(config->topics, [&](const TopicOut& topic) { return topic.port == port; }))
        throw types::ConfigError("", "", "no topic of " + name() + " is for port " + port);
    if (framework::InputPortBase* const made = inputs_.make(port, source)) return made;
    throw types::ConfigError(
        "", "",
        source.path() + " is " + source.typeName() +
            ", which has no message; pings, poses, points, ranges, pictures, numbers and texts have");
}

void PublisherTask::listenToWarnings() {
    if (lines_ || !environment().warn || !(config->sends_diagnostics || config->sends_rosout)) return;
    lines_ = std::make_shared<LogLines>();
    environment().warn = [warn_user = environment().warn, lines = lines_](const std::string& text) {
        warn_user(text);
        lines->add(LogLines::warning, text);
    };
}

void PublisherTask::check(types::Diagnostics& diagnostics) const {
    for (size_t i = 0; i < config->topics.size(); ++i) {
        const TopicOut& topic = config->topics[i];
        const std::string path = "topics[" + std::to_string(i) + "].";
        bool has_input = false;
        inputs_.forEach([&](const auto& input) {
            if (input.port.name() != topic.port) return;
            has_input = true;
            if (const std::string why = whyNot(input, topic); !why.empty()) diagnostics.push_back({path + "type", why});
        });
        if (!has_input)
            diagnostics.push_back(
                {path + "port", "is " + topic.port + "; no connection leads to " + name() + "." + topic.port});
    }
    const auto* const deployment = dynamic_cast<framework::Deployment*>(environment().deployment);
    if (!deployment || !config->lifecycle) return;
    std::vector<std::string> others = deployment->spec().taskNames();
    std::erase(others, name());
    if (std::ranges::count(others, *config->lifecycle) == 0)
        diagnostics.push_back({"lifecycle", "is " + *config->lifecycle + "; must be another task, " +
                                                framework::suggestion(*config->lifecycle, others)});
}

types::Notices PublisherTask::notices() const {
    types::Notices notices;
    for (std::string& line : config->sharedFrames()) notices.push_back(std::move(line));
    const std::string& space = environment().names.ros_namespace;
    std::string outside;
    for (const TopicOut& topic : config->topics)
        if (!space.empty() && topic.topic.starts_with('/') && topic.topic != "/tf" && topic.topic != "/clock")
            outside += (outside.empty() ? "" : ", ") + topic.topic;
    if (!outside.empty())
        notices.push_back("not in the namespace " + space + ", because their names begin with a slash: " + outside);
    for (std::string& line : drops_.summary()) notices.push_back(std::move(line));
    return notices;
}

bool PublisherTask::configureHook() {
    cleanupHook();  // remains of a failed configure
    drops_.reset();
    const types::RosNames& names = environment().names;
    const PublisherConfig named = config->namedBy(names, name());
    refuseWrong(named);
    node_.emplace(domainId(named.node.domain), named.node.node_name, static_cast<size_t>(named.node.gid_size));
    inputs_.forEach([&]<class Input>(Input& input) {
        using Sending = Publication<typename Input::Sample>;
        for (const TopicOut& topic : named.topics)
            if (topic.port == input.port.name())
                input.kept.publications.push_back(
                    std::make_unique<Sending>(*node_, named, topic, names.frame_prefix, drops_));
    });
    if (named.tf_static) announceMounts(named.tf_static->topic);
    if (auto* const deployment = dynamic_cast<framework::Deployment*>(environment().deployment))
        serve(named, *deployment);
    readSonars();
    node_->announce();
    if (server_) server_->start();
    return true;
}

void PublisherTask::serve(const PublisherConfig& named, framework::Deployment& deployment) {
    if (!named.parameter_services && !named.lifecycle && !lines_) return;
    has_other_clock_ = environment().lockstep;
    server_.emplace(*node_, named.node.node_name, environment().names);
    if (named.parameter_services)
        parameters_.emplace(
            *server_, name(), deployment, [&deployment](const auto& values) { deployment.set(values, ""); },
            [this] { return has_other_clock_.load(); });
    const auto counts = [&deployment](const std::string& task) {
        framework::Timing& timing = deployment.task(task)->timing();
        return TaskCounts{std::atomic_ref(timing.overruns).load(std::memory_order_relaxed), timing.hangs};
    };
    if (lines_) reports_.emplace(*server_, deployment, counts, lines_, named.sends_diagnostics, named.sends_rosout);
    if (!named.lifecycle) return;
    lifecycle_.emplace(*server_, *named.lifecycle, deployment,
                       [lines = lines_, task = *named.lifecycle](const std::string& refused) {
                           if (lines) lines->add(LogLines::error, task + ": " + refused);
                       });
}

bool PublisherTask::startHook() {
    has_other_clock_ = environment().lockstep || !environment().wall_clock;
    const auto* const deployment = dynamic_cast<framework::Deployment*>(environment().deployment);
    if (!lines_ || !deployment) return true;
    for (const auto& task : deployment->tasks()) {
        if (task->state() != framework::TaskState::Stopped) continue;  // it runs, or has none yet
        for (const types::Notice& notice : task->notices())
            lines_->add(notice.kind == types::Notice::Kind::Warning ? LogLines::warning : LogLines::info,
                        task->name() + ": " + notice.text);
    }
    return true;
}

ros::TFMessage PublisherTask::mounts() const {
    ros::TFMessage message;
    inputs_.forEach([&]<class Input>(const Input& input) {
        constexpr bool of_the_world = std::is_same_v<typename Input::Sample, types::PointCloud>;
        const auto mount = of_the_world ? std::nullopt : framework::upstreamMount(input.port);
        for (const TopicOut& topic : config->topics) {
            const auto axes = getAxes(topic);
            const std::string frame = environment().names.frame(config->getFrame(topic));
            const bool is_known =
                std::ranges::count(message.transforms, frame, &ros::TransformStamped::child_frame_id) > 0;
            if (topic.port != input.port.name() || !mount || !axes || is_known) continue;
            message.transforms.push_back({{ros::toRos(now()), environment().names.frame(config->tf_static->frame_id)},
                                          frame,
                                          ros::toTransform(*mount, config->node.world_frame, *axes)});
        }
    });
    return message;
}

void PublisherTask::announceMounts(const std::string& topic) {
    using Message = ros::TFMessage;
    const Quality quality{.reliability = Reliability::Reliable, .depth = 1, .transient_local = true};
    tf_static_.emplace(*node_, ddsTopic(topic), Message::type_name, ros::typeHash<Message>(), quality);
    node_->addWriter(tf_static_->handle());
    Bytes bytes;
    ros::encode(mounts(), bytes);
    if (!tf_static_->write(bytes)) throw std::runtime_error("the mounts cannot be published: " + tf_static_->failure());
}

void PublisherTask::readSonars() {
    known_changes_ = *environment().record_changes;
    inputs_.forEach([](auto& input) {
        const auto given = framework::upstreamNumber(input.port, {"frequency_khz", "absorption.frequency_khz"});
        const double frequency = given.value_or(0);
        const types::ReturnRules rules = framework::upstreamReturnRules(input.port, types::left_receiver);
        for (const auto& publication : input.kept.publications) publication->setSonar(frequency, rules);
    });
}

void PublisherTask::updateHook() {
    using Clock = std::chrono::steady_clock;
    if (*environment().record_changes != known_changes_) readSonars();
    inputs_.forEach([this]<class Input>(Input& input) {
        auto start = Clock::now();
        for (typename Input::Carried sample{}; input.port.readNew(sample); start = Clock::now()) {
            send(input, sample, *this);
            for (const auto& publication : input.kept.publications)
                if (const std::string warning = publication->consumeSizeWarning(); !warning.empty()) warn(warning);
            recordStage("send", std::chrono::duration<double>(Clock::now() - start).count());
        }
    });
    if (const std::string reported = drops_.consumeWarning(); !reported.empty()) warn(reported);
}

void PublisherTask::cleanupHook() {
    inputs_.forEach([](auto& input) { input.kept.publications.clear(); });
    server_.reset();
    lifecycle_.reset();
    reports_.reset();
    parameters_.reset();
    tf_static_.reset();
    node_.reset();
}

void registerTasks(framework::Registry& registry) {
    registry.add<PublisherTask>("dds::PublisherTask", "sends pings, poses and pictures as ROS 2 messages");
    registry.add<SubscriberTask>("dds::SubscriberTask", "reads poses that ROS 2 nodes send");
    registry.add<TransformTask>("dds::TransformTask", "publishes the poses of frames of ROS 2's tf in the world");
}

}  // namespace insonify::dds
