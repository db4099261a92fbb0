#include "components/viewer/ViewerTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "components/framework/DeploymentControl.hpp"
#include "types/ConfigError.hpp"

namespace insonify::viewer {

/** One input. */
class ViewerTask::Inlet {
public:
    explicit Inlet(Source of) : source(std::move(of)) {}
    virtual ~Inlet() = default;
    virtual framework::InputPortBase& port() const = 0;
    /** Hands the newest over; gives what is wrong with one, or nothing. */
    virtual std::string drain(Publisher& publisher, size_t number, types::Time now) = 0;
    const Source source;
};

namespace {

/** What is wrong with what came; empty: nothing. */
template <class T>
std::string diagnosticOf(const T* sample) {
    const char* const what = sample ? types::diagnosticOf(*sample) : "is null";
    return what ? what : "";
}

}  // namespace

template <class T>
class ViewerTask::TypedInlet final : public Inlet {
public:
    using Port = framework::InputPort<T>;

    TypedInlet(std::unique_ptr<framework::InputPortBase> port, Source of)
        : Inlet(std::move(of)), owned_(std::move(port)), port_(static_cast<Port&>(*owned_)) {}
    framework::InputPortBase& port() const override { return port_; }
    std::string drain(Publisher& publisher, size_t number, types::Time now) override {
        std::string told;
        for (T sample{}; port_.readNew(sample);) {
            const std::string diagnostic = diagnosticOf(types::carriedSample(sample));
            if (diagnostic.empty())
                publisher.offer(number, std::move(sample), now);
            else
                told = port_.path() + ": a sample " + diagnostic + "; it is not shown";
        }
        return told;
    }

private:
    std::unique_ptr<framework::InputPortBase> owned_;
    Port& port_;
};

ViewerTask::ViewerTask(std::string name) : TaskContext(std::move(name)) {}
ViewerTask::~ViewerTask() = default;

framework::InputPortBase* ViewerTask::makeInput(const std::string& port, framework::OutputPortBase& source) {
    const size_t before = inlets_.size();
    const auto take = [&]<class T, class Carried>(std::type_identity<T>, std::type_identity<Carried>) {
        if (dynamic_cast<framework::OutputPort<Carried>*>(&source))
            inlets_.push_back(std::make_unique<TypedInlet<Carried>>(
                source.makeReader(this, port), Source{source.path(), channelOf<T>(source.path()), on_pages<T>}));
    };
    types::forEachSampleType(
        [&]<class T>(std::type_identity<T> type) { take(type, std::type_identity<types::Carried<T>>{}); });
    take(std::type_identity<types::Snapshot>{}, std::type_identity<types::SnapshotPtr>{});
    if (inlets_.size() == before)
        throw types::ConfigError("", "",
                                 source.path() + " is " + source.typeName() +
                                     ", which a viewer cannot show; it shows what a log can hold, and snapshots");
    return &inlets_.back()->port();
}

std::vector<std::string> ViewerTask::notices() const {
    if (!publisher_) return {};
    const bool v6 = config->address.find(':') != std::string::npos;
    const std::string host = v6 ? "[" + config->address + "]" : config->address;
    std::vector<std::string> notices{fmt::format(
        "open http://{}:{}/{}", host, port(), config->token.empty() && config->token_file.empty() ? "" : "?token=...")};
    const ServerCounts so_far = counts();
    if (so_far.refused > 0) notices.push_back(fmt::format("{} connections refused", so_far.refused));
    if (so_far.dropped > 0) notices.push_back(fmt::format("{} frames not sent, for newer ones", so_far.dropped));
    return notices;
}

void ViewerTask::refuseOwn(const std::string& operation) const {
    static constexpr std::array life_cycle{".configure", ".start", ".stop", ".cleanup", ".recover"};
    if (operation.starts_with(name() + ".")) throw std::runtime_error("the viewer does not steer itself");
    if (std::ranges::any_of(life_cycle, [&](const char* ending) { return operation.ends_with(ending); }))
        throw std::runtime_error("states of tasks are the deployment's to change");
}

Access ViewerTask::access() {
    const auto tell = [this](const std::string& text) { warn(text); };
    framework::DeploymentControl* const deployment = environment().deployment;
    if (!deployment) {
        const auto refuse = [] { throw std::runtime_error("there is no deployment around this viewer"); };
        return {[] { return types::DeploymentStatus{}; },
                [] { return std::vector<types::TaskInterface>{}; },
                [refuse](const std::string&, const std::vector<std::string>&) { return refuse(), std::string(); },
                [refuse](bool) { refuse(); },
                [refuse] { refuse(); },
                tell};
    }
    return {[deployment] { return deployment->status(); },
            [deployment] { return deployment->interfaces(); },
            [this, deployment](const std::string& operation, const std::vector<std::string>& arguments) {
                refuseOwn(operation);
                return deployment->call(operation, arguments);
            },
            [deployment](bool on) { deployment->pause(on); },
            [deployment] { deployment->step(); },
            tell};
}

bool ViewerTask::configureHook() {
    std::vector<Source> sources;
    for (const auto& inlet : inlets_) sources.push_back(inlet->source);
    ViewerConfig whole = *config;
    if (!whole.token_file.empty()) whole.token = readToken();
    try {
        publisher_ = std::make_unique<Publisher>(whole, std::move(sources), access());
    } catch (const ListenError& error) {
        throw types::ConfigError("", name() + "." + error.property, error.what());
    }
    return true;
}

std::string ViewerTask::readToken() const {
    const std::filesystem::path file = inputPath(config->token_file);
    std::string token;
    std::getline(std::ifstream(file), token);
    if (token.ends_with('\r')) token.pop_back();
    if (!token.empty()) return token;
    throw types::ConfigError("", name() + ".token_file",
                             "is " + file.string() + ", which has no token in its first line, or cannot be read");
}

void ViewerTask::updateHook() {
    std::string diagnostic = publisher_->takeTrouble();
    for (size_t i = 0; i < inlets_.size(); ++i)
        if (std::string wrong = inlets_[i]->drain(*publisher_, i, now()); !wrong.empty()) diagnostic = std::move(wrong);
    if (!diagnostic.empty()) error(diagnostic);
}

void ViewerTask::errorHook() {
    recover();
    updateHook();
}

void ViewerTask::cleanupHook() { publisher_.reset(); }

}  // namespace insonify::viewer
