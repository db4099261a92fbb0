#include "components/viewer/ViewerTask.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "types/text/ConfigError.hpp"

namespace insonify::viewer {

namespace {

/** Returns what is wrong with a sample; empty if nothing is. */
template <class T>
std::string findDiagnostic(const T* sample) {
    const char* const what = types::findDiagnostic(*sample);
    return what ? what : "";
}

/** Passes new samples to a source; returns what is wrong with one of them, or an empty text. */
template <class Input>
std::string drain(Input& input, Publisher& publisher, size_t source, types::Time now) {
    std::string reported;
    for (typename Input::Carried sample{}; input.port.readNew(sample);) {
        const std::string diagnostic = findDiagnostic(types::carriedSample(sample));
        if (diagnostic.empty())
            publisher.offer(source, std::move(sample), now);
        else
            reported = input.port.path() + ": a sample " + diagnostic + "; it is not shown";
    }
    return reported;
}

}  // namespace

framework::InputPortBase* ViewerTask::makeInput(const std::string& port, framework::OutputPortBase& source) {
    if (framework::InputPortBase* const made = inputs_.make(port, source, source.path())) return made;
    throw types::ConfigError(
        "", "",
        source.path() + " is " + source.typeName() +
            ", which a viewer cannot show; it shows all types that a log can contain, and snapshots");
}

types::Notices ViewerTask::notices() const {
    if (!publisher_) return {};
    const bool v6 = config->address.find(':') != std::string::npos;
    const std::string host = v6 ? "[" + config->address + "]" : config->address;
    types::Notices notices{fmt::format("open http://{}:{}/{}", host, port(),
                                       config->token.empty() && config->token_file.empty() ? "" : "?token=...")};
    const ServerCounts so_far = counts();
    if (so_far.refused > 0) notices.push_back(fmt::format("{} connections refused", so_far.refused));
    if (so_far.dropped > 0)
        notices.push_back(fmt::format("{} frames dropped: replaced by newer frames", so_far.dropped));
    return notices;
}

bool ViewerTask::configureHook() {
    std::vector<Source> sources;
    inputs_.forEach([&](const auto& input) { sources.push_back(input.kept.source); });
    ViewerConfig whole = *config;
    if (!whole.token_file.empty()) whole.token = readToken();
    try {
        const auto report = [this](const std::string& text) { warn(text); };
        publisher_ =
            std::make_unique<Publisher>(whole, std::move(sources), Host{name(), environment().deployment, report});
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
    std::string diagnostic = publisher_->consumeError();
    size_t source = 0;
    inputs_.forEach([&](auto& input) {
        if (std::string reported = drain(input, *publisher_, source++, now()); !reported.empty())
            diagnostic = std::move(reported);
    });
    if (!diagnostic.empty()) error(diagnostic);
}

void ViewerTask::errorHook() {
    recover();
    updateHook();
}

void ViewerTask::cleanupHook() { publisher_.reset(); }

void registerTasks(framework::Registry& registry) {
    registry.add<ViewerTask>("viewer::ViewerTask",
                             "shows the running deployment: a page in the browser, and data for Foxglove");
}

}  // namespace insonify::viewer
