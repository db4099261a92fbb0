#include "components/viewer/Publisher.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include "components/viewer/Page.hpp"
#include "components/viewer/SceneMesh.hpp"

namespace insonify::viewer {
namespace {

constexpr auto status_period = std::chrono::milliseconds(500);
constexpr uint32_t status_stream = 0, first_source_stream = 1;

ServerOptions optionsOf(const ViewerConfig& config, const std::vector<Source>& sources) {
    ServerOptions options{config.address,      static_cast<uint16_t>(config.port),
                          config.token,        static_cast<size_t>(config.clients),
                          config.idle_timeout, {}};
    for (const Source& source : sources) options.channels.push_back(source.channel);
    return options;
}

/** 0 for a time before the epoch. */
uint64_t nanosecondsOf(types::Time stamp) {
    return static_cast<uint64_t>(std::max<int64_t>(0, stamp.microseconds)) * 1000;
}

}  // namespace

Publisher::Publisher(const ViewerConfig& config, std::vector<Source> sources, Host host)
    : config_(config),
      sources_(std::move(sources)),
      host_(std::move(host)),
      picture_(config.messages.scale),
      messages_(config.messages, config.world_frame),
      slots_(sources_.size()),
      tasks_(host_.deployment ? host_.deployment->interfaces() : std::vector<types::TaskInterface>{}),
      interfaces_(bytesOf(interfacesText(tasks_, config.control))),
      server_(optionsOf(config_, sources_), *this),
      publishing_(&Publisher::publishAll, this) {}

Publisher::~Publisher() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
    }
    fresh_.notify_all();
    publishing_.join();
    executors_.end();  // they answer through the server
}

void Publisher::offer(size_t source, AnySample sample, types::Time now) {
    const types::Time stamp = stampOf(sample, now);
    {
        std::lock_guard lock(mutex_);
        Slot& slot = slots_[source];
        if (slot.shown != slot.count) skipped_ += audience(source);
        slot.sample = std::move(sample);
        slot.stamp = stamp;
        slot.latency_s = (now - stamp).seconds();
        slot.fresh = true;
        ++slot.count;
    }
    fresh_.notify_one();
}

/** How many clients a sample goes to. */
uint64_t Publisher::audience(size_t source) const {
    return server_.subscribers(static_cast<uint32_t>(source)) + (sources_[source].on_pages ? server_.pages() : 0);
}

ServerCounts Publisher::counts() const {
    ServerCounts counts = server_.counts();
    counts.dropped += skipped_;
    return counts;
}

std::string Publisher::takeError() {
    std::lock_guard lock(mutex_);
    return std::exchange(diagnostic_, {});
}

std::optional<PageFile> Publisher::file(std::string_view path) { return pageFile(path); }

std::vector<Frame> Publisher::greeting() {
    std::lock_guard lock(mutex_);
    for (Slot& slot : slots_) slot.fresh = slot.count > 0;  // the newcomer has seen none
    fresh_.notify_one();
    std::vector<Frame> frames{{"", interfaces_, true}};
    for (const auto& [source, scene] : scenes_) frames.push_back({"", scene, false});
    return frames;
}

// -- samples ----------------------------------------------------------------------------------------------------------

void Publisher::publishAll() {
    auto next_status = std::chrono::steady_clock::now();
    std::unique_lock lock(mutex_);
    while (!ending_) {
        const auto isFresh = [](const Slot& slot) { return slot.fresh; };
        fresh_.wait_until(lock, next_status, [&] { return ending_ || std::ranges::any_of(slots_, isFresh); });
        for (size_t i = 0; i < slots_.size() && !ending_; ++i) {
            if (!std::exchange(slots_[i].fresh, false)) continue;
            slots_[i].shown = slots_[i].count;
            const Slot slot = slots_[i];
            lock.unlock();
            publish(i, slot);
            lock.lock();
        }
        if (ending_ || std::chrono::steady_clock::now() < next_status) continue;
        lock.unlock();
        if (const std::string warning = server_.takeWarning(); !warning.empty()) host_.warn(warning);
        showStatus();
        next_status = std::chrono::steady_clock::now() + status_period;
        lock.lock();
    }
}

void Publisher::publish(size_t source, const Slot& slot) try {
    const auto channel = static_cast<uint32_t>(source);
    if (server_.pages() > 0) showOnPages(source, slot);
    if (server_.subscribers(channel) > 0)
        server_.toFoxglove(channel, nanosecondsOf(slot.stamp), messages_.encode(slot.sample));
} catch (const std::exception& error) {
    std::lock_guard lock(mutex_);
    diagnostic_ = sources_[source].name + ": cannot be shown: " + error.what();
}

void Publisher::showOnPages(size_t source, const Slot& slot) {
    const uint32_t stream = first_source_stream + static_cast<uint32_t>(source);
    const std::string& name = sources_[source].name;
    if (const auto* ping = std::get_if<types::SonarPtr>(&slot.sample))
        server_.toPages(stream, {"", bytesOf(picture_.encode(**ping, {name, slot.latency_s, slot.count})), false});
    else if (const auto* pose = std::get_if<types::Pose>(&slot.sample))
        server_.toPages(stream, {"", bytesOf(poseText(*pose, name)), true});
    else if (const auto* snapshot = std::get_if<types::SnapshotPtr>(&slot.sample)) {
        showScene(source, (*snapshot)->geometry);
        server_.toPages(stream, {"", bytesOf(snapshotText(**snapshot, name)), true});
    }
}

void Publisher::showScene(size_t source, const types::GeometryPtr& geometry) {
    if (!geometry || geometry == geometries_[source]) return;
    geometries_[source] = geometry;
    const auto most = static_cast<size_t>(config_.max_triangles);
    const Bytes scene = bytesOf(sceneMessage(*geometry, most, sources_[source].name));
    {
        std::lock_guard lock(mutex_);
        scenes_[source] = scene;  // first, so that who comes now gets it twice rather than not at all
    }
    server_.toPages(first_source_stream + static_cast<uint32_t>(sources_.size() + source), {"", scene, false});
}

void Publisher::showStatus() try {
    if (server_.pages() == 0) return;
    const auto status = host_.deployment ? host_.deployment->status() : types::DeploymentStatus{};
    server_.toPages(status_stream, {"", bytesOf(statusText(status, counts())), true});
} catch (const std::exception& error) {
    std::lock_guard lock(mutex_);
    diagnostic_ = std::string("the state of the tasks cannot be shown: ") + error.what();
}

// -- requests ---------------------------------------------------------------------------------------------------------

void Publisher::request(uint64_t client, std::string text) {
    Request request;
    try {
        readRequest(text, request);
    } catch (const std::exception& error) {
        return server_.reply(client, refusalText(request.id, error.what()));
    }
    if (!executors_.run(laneOf(request), [this, client, request] { server_.reply(client, answer(request)); }))
        server_.reply(client, refusalText(request.id, "too many requests wait; try again later"));
}

/** The task that is called; empty: none that there is. */
std::string Publisher::laneOf(const Request& request) const {
    const std::string task = request.operation.substr(0, request.operation.find('.'));
    return std::ranges::find(tasks_, task, &types::TaskInterface::name) == tasks_.end() ? "" : task;
}

std::string Publisher::answer(const Request& request) const try {
    return answerText(request.id, carryOut(request));
} catch (const std::exception& error) {
    return refusalText(request.id, error.what());
}

std::string Publisher::carryOut(const Request& request) const {
    if (!config_.control) throw std::runtime_error("this viewer only shows (control: false)");
    if (!host_.deployment) throw std::runtime_error("there is no deployment around this viewer");
    switch (request.kind) {
        case Request::Kind::Call:
            refuseOwn(request.operation);
            return host_.deployment->call(request.operation, request.arguments);
        case Request::Kind::Pause: host_.deployment->pause(request.on); break;
        case Request::Kind::Step: host_.deployment->step(); break;
    }
    return "";
}

void Publisher::refuseOwn(const std::string& operation) const {
    static constexpr std::array life_cycle{".configure", ".start", ".stop", ".cleanup", ".recover"};
    if (operation.starts_with(host_.viewer + ".")) throw std::runtime_error("the viewer does not steer itself");
    if (std::ranges::any_of(life_cycle, [&](const char* ending) { return operation.ends_with(ending); }))
        throw std::runtime_error("states of tasks are the deployment's to change");
}

}  // namespace insonify::viewer
