#include "components/dds/PublisherTask.hpp"

#include <algorithm>
#include <chrono>

#include "components/dds/Publication.hpp"
#include "types/ConfigError.hpp"

namespace insonify::dds {
namespace {

const types::Pose& contentOf(const types::Pose& pose) { return pose; }
template <class T>
const T& contentOf(const std::shared_ptr<const T>& sample) {
    return *sample;
}
bool isNull(const types::Pose&) { return false; }
template <class T>
bool isNull(const std::shared_ptr<const T>& sample) {
    return !sample;
}

}  // namespace

template <class Carried>
class PublisherTask::TypedInlet final : public Inlet {
public:
    using Sample = std::remove_cvref_t<decltype(contentOf(std::declval<Carried>()))>;

    explicit TypedInlet(std::unique_ptr<framework::InputPortBase> port)
        : owned_(std::move(port)), port_(static_cast<framework::InputPort<Carried>&>(*owned_)) {}
    framework::InputPortBase& port() const override { return port_; }
    std::string messages() const override { return messagesOf<Sample>(); }
    void open(Node& node, const PublisherConfig& config) override {
        publications_.clear();  // of a configure that failed
        for (const TopicOut& topic : config.topics)
            if (topic.port == port_.name())
                publications_.push_back(std::make_unique<Publication<Sample>>(node, config, topic));
    }
    void close() override { publications_.clear(); }
    bool send() override {
        Carried sample{};
        if (!port_.readNew(sample)) return false;
        if (isNull(sample)) throw std::invalid_argument(port_.path() + ": a sample is null");
        for (const auto& publication : publications_) publication->publish(contentOf(sample));
        return true;
    }
    void addLosses(std::vector<std::string>& notices) const override {
        for (const auto& publication : publications_)
            if (std::string losses = publication->losses(); !losses.empty()) notices.push_back(std::move(losses));
    }

private:
    std::unique_ptr<framework::InputPortBase> owned_;
    framework::InputPort<Carried>& port_;
    std::vector<std::unique_ptr<Publication<Sample>>> publications_;
};

template <class Carried>
bool PublisherTask::addInlet(const std::string& port, framework::OutputPortBase& source) {
    if (!dynamic_cast<framework::OutputPort<Carried>*>(&source)) return false;
    inlets_.push_back(std::make_unique<TypedInlet<Carried>>(source.makeReader(this, port)));
    return true;
}

framework::InputPortBase* PublisherTask::makeInput(const std::string& port, framework::OutputPortBase& source) {
    if (std::ranges::none_of(config->topics, [&](const TopicOut& topic) { return topic.port == port; }))
        throw types::ConfigError("", "", "no topic of " + name() + " is for port " + port);
    if (addInlet<types::SonarPtr>(port, source) || addInlet<types::Pose>(port, source) ||
        addInlet<types::ImagePtr>(port, source))
        return &inlets_.back()->port();
    throw types::ConfigError(
        "", "",
        source.path() + " is " + source.typeName() + ", of which no message is made; pings, poses and pictures are");
}

void PublisherTask::check(types::Problems& problems) const {
    for (size_t i = 0; i < config->topics.size(); ++i) {
        const TopicOut& topic = config->topics[i];
        const std::string path = "topics[" + std::to_string(i) + "].";
        const auto inlet =
            std::ranges::find_if(inlets_, [&](const auto& one) { return one->port().name() == topic.port; });
        if (inlet == inlets_.end()) {
            problems.push_back(
                {path + "port", "is " + topic.port + "; no connection leads to " + name() + "." + topic.port});
            continue;
        }
        const std::string type(types::EnumNames<MessageType>::names[static_cast<size_t>(topic.type)]);
        const std::string able = (*inlet)->messages();
        if (able.find(type) == std::string::npos)
            problems.push_back({path + "type", "is " + type + "; " + (*inlet)->port().typeName() + " can be " + able});
    }
}

std::vector<std::string> PublisherTask::notices() const {
    std::vector<std::string> notices;
    for (const auto& inlet : inlets_) inlet->addLosses(notices);
    return notices;
}

bool PublisherTask::configureHook() {
    node_.emplace(domainId(config->node.domain), config->node.nameOr(name()),
                  static_cast<size_t>(config->node.gid_size));
    for (const auto& inlet : inlets_) inlet->open(*node_, *config);
    node_->announce();
    return true;
}

void PublisherTask::updateHook() {
    using Clock = std::chrono::steady_clock;
    for (const auto& inlet : inlets_)
        for (auto start = Clock::now(); inlet->send(); start = Clock::now())
            recordStage("send", std::chrono::duration<double>(Clock::now() - start).count());
}

void PublisherTask::cleanupHook() {
    for (const auto& inlet : inlets_) inlet->close();
    node_.reset();
}

}  // namespace insonify::dds
