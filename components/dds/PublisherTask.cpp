#include "components/dds/PublisherTask.hpp"

#include <algorithm>
#include <chrono>

#include "components/dds/Publication.hpp"
#include "components/framework/Latency.hpp"
#include "types/ConfigError.hpp"

namespace insonify::dds {
namespace {

void tellLatency(framework::TaskContext& task, const auto& sample) {
    if constexpr (requires { sample.time; }) framework::noteLatency(task, sample.time);
}

}  // namespace

template <class Sample>
class PublisherTask::TypedInlet final : public Inlet {
public:
    using Carried = types::Carried<Sample>;

    explicit TypedInlet(std::unique_ptr<framework::InputPortBase> port)
        : owned_(std::move(port)), port_(static_cast<framework::InputPort<Carried>&>(*owned_)) {}
    framework::InputPortBase& port() const override { return port_; }
    bool canBe(MessageType type) const override { return dds::canBe<Sample>(type); }
    std::string messages() const override { return messagesOf<Sample>(); }
    void open(Node& node, const PublisherConfig& config, types::ThrottledWarning& drops) override {
        for (const TopicOut& topic : config.topics)
            if (topic.port == port_.name())
                publications_.push_back(std::make_unique<Publication<Sample>>(node, config, topic, drops));
    }
    void close() override { publications_.clear(); }
    bool send(PublisherTask& task) override {
        Carried sample{};
        if (!port_.readNew(sample)) return false;
        const Sample* const content = types::carriedSample(sample);
        if (!content) return task.drops_.add(port_.path() + ": a sample is null"), true;
        for (const auto& publication : publications_)
            if (publication->publish(*content)) tellLatency(task, *content);
        return true;
    }

private:
    std::unique_ptr<framework::InputPortBase> owned_;
    framework::InputPort<Carried>& port_;
    std::vector<std::unique_ptr<Publication<Sample>>> publications_;
};

framework::InputPortBase* PublisherTask::makeInput(const std::string& port, framework::OutputPortBase& source) {
    if (std::ranges::none_of(config->topics, [&](const TopicOut& topic) { return topic.port == port; }))
        throw types::ConfigError("", "", "no topic of " + name() + " is for port " + port);
    const size_t before = inlets_.size();
    types::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (dynamic_cast<framework::OutputPort<types::Carried<T>>*>(&source))
            inlets_.push_back(std::make_unique<TypedInlet<T>>(source.makeReader(this, port)));
    });
    if (inlets_.size() > before) return &inlets_.back()->port();
    throw types::ConfigError("", "",
                             source.path() + " is " + source.typeName() +
                                 ", of which no message is made; pings, poses, pictures, numbers and texts are");
}

void PublisherTask::check(types::Diagnostics& diagnostics) const {
    for (size_t i = 0; i < config->topics.size(); ++i) {
        const TopicOut& topic = config->topics[i];
        const std::string path = "topics[" + std::to_string(i) + "].";
        const auto inlet =
            std::ranges::find_if(inlets_, [&](const auto& one) { return one->port().name() == topic.port; });
        if (inlet == inlets_.end()) {
            diagnostics.push_back(
                {path + "port", "is " + topic.port + "; no connection leads to " + name() + "." + topic.port});
            continue;
        }
        const std::string type(types::EnumNames<MessageType>::names[static_cast<size_t>(topic.type)]);
        if (!(*inlet)->canBe(topic.type))
            diagnostics.push_back(
                {path + "type", "is " + type + "; " + (*inlet)->port().typeName() + " can be " + (*inlet)->messages()});
    }
}

std::vector<std::string> PublisherTask::notices() const {
    std::vector<std::string> notices = config->sharedFrames();
    std::ranges::move(drops_.summary(), std::back_inserter(notices));
    return notices;
}

bool PublisherTask::configureHook() {
    cleanupHook();  // what a configure that failed has left
    drops_.reset();
    node_.emplace(domainId(config->node.domain), config->node.nameOr(name()),
                  static_cast<size_t>(config->node.gid_size));
    for (const auto& inlet : inlets_) inlet->open(*node_, *config, drops_);
    node_->announce();
    return true;
}

void PublisherTask::updateHook() {
    using Clock = std::chrono::steady_clock;
    for (const auto& inlet : inlets_)
        for (auto start = Clock::now(); inlet->send(*this); start = Clock::now())
            recordStage("send", std::chrono::duration<double>(Clock::now() - start).count());
    if (const std::string told = drops_.takeWarning(); !told.empty()) warn(told);
}

void PublisherTask::cleanupHook() {
    for (const auto& inlet : inlets_) inlet->close();
    node_.reset();
}

}  // namespace insonify::dds
