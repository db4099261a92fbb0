#include "components/viewer/Publisher.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "components/console/Json.hpp"
#include "components/viewer/SceneMesh.hpp"
#include "components/viewer/Server.hpp"
#include "types/Thread.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::viewer {
namespace {

using Json = nlohmann::json;

/** Replaces invalid UTF-8. */
std::string dump(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json numberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json getValue(const types::PropertyValue& value) {
    return std::visit([](const auto& held) { return Json(held); }, value);
}

/** Hides tokens, because clients may be shown to others. */
Json shown(const std::string& name, const types::PropertyValue& value) {
    const auto* text = std::get_if<std::string>(&value);
    const bool is_secret = name == "token" || name.ends_with(".token");
    return is_secret && text && !text->empty() ? Json("...") : getValue(value);
}

Json makePlan(const types::Plan& plan) {
    Json omitted = Json::array();
    for (const types::Omission& omission : plan.omitted)
        omitted.push_back({{"name", omission.name}, {"reason", omission.reason}});
    return {{"features", plan.features}, {"passes", plan.passes},
            {"omitted", omitted},        {"notices", types::lines(plan.notices)},
            {"rows", plan.rows},         {"columns_per_beam", plan.columns_per_beam},
            {"slabs", plan.slabs},       {"predicted_error", numberOrNull(plan.predicted_error)},
            {"device", plan.device}};
}

Json getTask(const types::TaskStatus& task) {
    Json properties = Json::object(), outputs = Json::array();
    for (const auto& [name, value] : task.record.properties) properties[name] = shown(name, value);
    for (const types::PortStatus& port : task.outputs)
        outputs.push_back({{"name", port.name}, {"type", port.type}, {"written", port.written}});
    Json json = {{"name", task.record.name}, {"type", task.record.type}, {"state", task.state},
                 {"error", task.error},      {"cycle_s", task.cycle_s},  {"latency_s", numberOrNull(task.latency_s)},
                 {"outputs", outputs},       {"properties", properties}};
    if (const auto& playback = task.playback)
        json["playback"] = {{"at_s", playback->at_s}, {"length_s", playback->length_s}, {"paused", playback->paused}};
    if (const auto& recording = task.recording)
        json["recording"] = {
            {"file", recording->file}, {"bytes", recording->bytes}, {"free_bytes", recording->free_bytes}};
    if (task.plan) json["plan"] = makePlan(*task.plan);
    return json;
}

constexpr auto status_period = std::chrono::milliseconds(250);
constexpr uint32_t status_stream = 0, first_source_stream = 1;

/** Names the session by the time of its start. */
std::string sessionName() {
    const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
    return std::to_string(std::chrono::duration_cast<std::chrono::microseconds>(since_epoch).count());
}

ServerOptions getOptions(const ViewerConfig& config, const std::vector<Source>& sources) {
    ServerOptions options{config.address,      static_cast<uint16_t>(config.port),
                          config.token,        static_cast<size_t>(config.clients),
                          config.idle_timeout, {},
                          sessionName()};
    for (const Source& source : sources)
        for (const FoxgloveForm& form : source.forms) options.channels.push_back(form.channel);
    return options;
}

std::vector<uint32_t> firstChannels(const std::vector<Source>& sources) {
    std::vector<uint32_t> first;
    uint32_t count = 0;
    for (const Source& source : sources) {
        first.push_back(count);
        count += static_cast<uint32_t>(source.forms.size());
    }
    return first;
}

std::vector<Messages> getMessages(const ViewerConfig& config, size_t sources) {
    return std::vector<Messages>(
        sources, Messages(config.messages, config.world_frame, static_cast<size_t>(config.max_triangles)));
}

/** Returns 0 for a time before the epoch. */
uint64_t nanoseconds(types::Time stamp) {
    return static_cast<uint64_t>(std::max<int64_t>(0, stamp.microseconds)) * 1000;
}

}  // namespace

std::string statusText(const types::DeploymentStatus& status, const ServerCounts& counts) {
    Json tasks = Json::array(), connections = Json::array();
    for (const types::TaskStatus& task : status.tasks) tasks.push_back(getTask(task));
    for (const types::ConnectionStatus& one : status.connections)
        connections.push_back({{"from", one.from},
                               {"to", one.to},
                               {"policy", one.policy},
                               {"lost", one.lost},
                               {"passed_over", one.passed_over}});
    return dump({{"type", "status"},
                 {"now_us", status.now.microseconds},
                 {"sent_s", std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count()},
                 {"lockstep", status.lockstep},
                 {"paused", status.paused},
                 {"tasks", tasks},
                 {"connections", connections},
                 {"clients", counts.clients},
                 {"refused", counts.refused},
                 {"dropped", counts.dropped}});
}

Parameters listParameters(const types::DeploymentStatus& status) {
    Parameters parameters;
    for (const types::TaskStatus& task : status.tasks)
        for (const auto& [name, value] : task.record.properties)
            parameters.emplace_back(task.record.name + "." + name, dump(shown(name, value)));
    return parameters;
}

std::string interfacesText(const std::vector<types::TaskInterface>& interfaces, bool control) {
    Json tasks = Json::array();
    for (const types::TaskInterface& task : interfaces) {
        Json properties = Json::array();
        for (const types::PropertyInfo& info : task.properties)
            properties.push_back({{"name", info.name},
                                  {"type", info.type},
                                  {"unit", info.unit},
                                  {"doc", info.doc},
                                  {"min", numberOrNull(info.min)},
                                  {"max", numberOrNull(info.max)},
                                  {"fixed", std::ranges::find(task.fixed, info.name) != task.fixed.end()}});
        tasks.push_back({{"name", task.name}, {"properties", properties}, {"operations", task.operations}});
    }
    return dump({{"type", "interfaces"}, {"control", control}, {"tasks", tasks}});
}

void readRequest(const std::string& text, Request& request) {
    const Json message = console::readJson<Json>(text);
    if (!message.is_object()) throw std::invalid_argument("is not a JSON object");
    const Json id = message.value("id", Json(0u));
    if (!id.is_number_unsigned()) throw std::invalid_argument("id is not an integer");
    request.id = id.get<uint64_t>();
    if (message.contains("pause") && message["pause"].is_boolean()) {
        request.kind = Request::Kind::Pause;
        request.on = message["pause"].get<bool>();
    } else if (message.contains("step")) {
        request.kind = Request::Kind::Step;
    } else if (message.contains("call") && message["call"].is_string()) {
        request.operation = message["call"].get<std::string>();
        const Json arguments = message.value("arguments", Json::array());
        if (!arguments.is_array()) throw std::invalid_argument("arguments are not a list");
        for (const Json& argument : arguments) {
            if (!argument.is_string()) throw std::invalid_argument("an argument is not a text");
            request.arguments.push_back(argument.get<std::string>());
        }
    } else {
        throw std::invalid_argument("has none of call, pause (true, false) and step");
    }
}

std::string answerText(uint64_t id, const std::string& result) {
    return dump({{"type", "answer"}, {"id", id}, {"result", result}});
}

std::string refusalText(uint64_t id, const std::string& why) {
    return dump({{"type", "answer"}, {"id", id}, {"refused", why}});
}

bool SerialExecutors::run(const std::string& name, Work work) {
    std::lock_guard lock(mutex_);
    if (ending_) return false;
    Executor& executor = executors_[name];
    if (executor.waiting == max_waiting) return false;
    ++executor.waiting;
    boost::asio::post(executor.thread, [&executor, work = std::move(work)] {
        --executor.waiting;
        work();
    });
    return true;
}

void SerialExecutors::end() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
        for (auto& [name, executor] : executors_) executor.thread.stop();
    }
    for (auto& [name, executor] : executors_) executor.thread.join();
}

Publisher::Publisher(const ViewerConfig& config, std::vector<Source> sources, Host host)
    : config_(config),
      sources_(std::move(sources)),
      host_(std::move(host)),
      picture_(config.messages.scale),
      messages_(getMessages(config, sources_.size())),
      first_channel_(firstChannels(sources_)),
      slots_(sources_.size()),
      tasks_(host_.deployment ? host_.deployment->interfaces() : std::vector<types::TaskInterface>{}),
      interfaces_(toBytes(interfacesText(tasks_, config.control))),
      server_(getOptions(config_, sources_), *this),
      publishing_(types::startThread("the samples of the live view", [this] { publishAll(); })) {}

Publisher::~Publisher() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
    }
    fresh_.notify_all();
    publishing_.join();
    executors_.end();  // their work replies through the server
}

void Publisher::offer(size_t source, AnySample sample, types::Time now) {
    const types::Time stamp = getStamp(sample, now);
    {
        std::lock_guard lock(mutex_);
        Slot& slot = slots_[source];
        if (slot.shown != slot.count) skipped_ += audience(source);
        slot.sample = std::move(sample);
        slot.stamp = stamp;
        slot.latency_s = (now - stamp).seconds();
        slot.fresh = true;
        ++slot.count;
        now_ = now;
    }
    fresh_.notify_one();
}

/** Returns the number of clients that receive a sample. */
uint64_t Publisher::audience(size_t source) const {
    uint64_t clients = sources_[source].on_pages ? server_.pages() : 0;
    for (uint32_t i = 0; i < sources_[source].forms.size(); ++i)
        clients += server_.subscribers(first_channel_[source] + i);
    return clients;
}

ServerCounts Publisher::counts() const {
    ServerCounts counts = server_.counts();
    counts.dropped += skipped_;
    return counts;
}

std::string Publisher::consumeError() {
    std::lock_guard lock(mutex_);
    return std::exchange(diagnostic_, {});
}

std::optional<PageFile> Publisher::file(std::string_view path) { return pageFile(path); }

std::vector<Frame> Publisher::greeting() {
    std::lock_guard lock(mutex_);
    for (Slot& slot : slots_) slot.fresh = slot.count > 0;  // the new client has seen none
    fresh_.notify_one();
    std::vector<Frame> frames{{"", interfaces_, true}};
    for (const auto& [source, scene] : scenes_) frames.push_back({"", scene, false});
    return frames;
}

void Publisher::subscribed(const std::vector<uint32_t>& channels) {
    {
        std::lock_guard lock(mutex_);
        for (size_t source = 0; source < slots_.size(); ++source)
            for (uint32_t i = 0; i < sources_[source].forms.size(); ++i) {
                if (std::ranges::find(channels, first_channel_[source] + i) == channels.end()) continue;
                slots_[source].fresh = slots_[source].count > 0;
                if (sources_[source].forms[i].form == Form::Scene) slots_[source].for_newcomer = true;
            }
    }
    fresh_.notify_one();
}

void Publisher::subscribedToParameters() {
    std::lock_guard lock(mutex_);
    newcomers_ = true;
}

// -- samples ----------------------------------------------------------------------------------------------------------

void Publisher::publishAll() {
    auto next_status = std::chrono::steady_clock::now();
    std::unique_lock lock(mutex_);
    while (!ending_) {
        const auto isFresh = [](const Slot& slot) { return slot.fresh; };
        fresh_.wait_until(lock, next_status, [&] { return ending_ || std::ranges::any_of(slots_, isFresh); });
        publishFresh(lock);
        if (ending_ || std::chrono::steady_clock::now() < next_status) continue;
        lock.unlock();
        if (const std::string warning = server_.consumeWarning(); !warning.empty()) host_.warn(warning);
        showStatus();
        next_status = std::chrono::steady_clock::now() + status_period;
        lock.lock();
    }
}

void Publisher::publishFresh(std::unique_lock<std::mutex>& lock) {
    if (std::exchange(newcomers_, false)) reported_.clear();
    bool any = false;
    for (size_t i = 0; i < slots_.size() && !ending_; ++i) {
        if (!std::exchange(slots_[i].fresh, false)) continue;
        slots_[i].shown = slots_[i].count;
        any = true;
        const Slot slot = slots_[i];
        slots_[i].for_newcomer = false;
        lock.unlock();
        publish(i, slot);
        lock.lock();
    }
    if (any) sendTime(now_);
}

void Publisher::sendTime(types::Time now) {
    if (server_.foxglove() > 0) server_.timeToFoxglove(nanoseconds(now));
}

void Publisher::publish(size_t source, const Slot& slot) try {
    if (server_.pages() > 0) showOnPages(source, slot);
    showInFoxglove(source, slot);
} catch (const std::exception& error) {
    std::lock_guard lock(mutex_);
    diagnostic_ = sources_[source].name + ": cannot be shown: " + error.what();
}

void Publisher::showInFoxglove(size_t source, const Slot& slot) {
    for (uint32_t i = 0; i < sources_[source].forms.size(); ++i) {
        const uint32_t channel = first_channel_[source] + i;
        const Form form = sources_[source].forms[i].form;
        if (server_.subscribers(channel) == 0) continue;
        if (form == Form::Scene)
            sendScene(channel, source, slot);
        else
            server_.toFoxglove(channel, nanoseconds(slot.stamp), messages_[source].encode(slot.sample, form));
    }
}

/** Sends a scene once, and then its moving objects. */
void Publisher::sendScene(uint32_t channel, size_t source, const Slot& slot) {
    const auto* const snapshot = std::get_if<types::SnapshotPtr>(&slot.sample);
    if (!snapshot) return;
    SceneUpdates& scene = messages_[source].scene();
    const bool whole = slot.for_newcomer || scene.isNew(**snapshot);
    Bytes message = whole ? scene.whole(**snapshot) : scene.moved(**snapshot);
    if (!message) return;
    if (whole)
        server_.everyToFoxglove(channel, nanoseconds(slot.stamp), std::move(message));
    else
        server_.toFoxglove(channel, nanoseconds(slot.stamp), std::move(message));
}

void Publisher::showOnPages(size_t source, const Slot& slot) {
    const uint32_t stream = first_source_stream + static_cast<uint32_t>(source);
    const std::string& name = sources_[source].name;
    if (const auto* ping = std::get_if<types::SonarPtr>(&slot.sample))
        server_.toPages(stream, {"", toBytes(picture_.encode(**ping, {name, slot.latency_s, slot.count})), false});
    else if (const auto* pose = std::get_if<types::Pose>(&slot.sample))
        server_.toPages(stream, {"", toBytes(poseText(*pose, name)), true});
    else if (const auto* snapshot = std::get_if<types::SnapshotPtr>(&slot.sample)) {
        showScene(source, (*snapshot)->geometry);
        const auto maximum = static_cast<size_t>(config_.max_triangles);
        server_.toPages(stream,
                        {"", toBytes(snapshotMessage(**snapshot, maximum, name)), (*snapshot)->deformed.empty()});
    }
}

void Publisher::showScene(size_t source, const types::GeometryPtr& geometry) {
    if (!geometry || geometry == geometries_[source]) return;
    geometries_[source] = geometry;
    const auto maximum = static_cast<size_t>(config_.max_triangles);
    const Bytes scene = toBytes(sceneMessage(*geometry, maximum, sources_[source].name));
    {
        std::lock_guard lock(mutex_);
        scenes_[source] = scene;  // first, so that a new client receives it twice rather than never
    }
    server_.toPages(first_source_stream + static_cast<uint32_t>(sources_.size() + source), {"", scene, false});
}

void Publisher::showStatus() try {
    const bool to_pages = server_.pages() > 0, to_foxglove = server_.foxglove() > 0;
    if (!to_pages && !to_foxglove) return;
    const auto status = host_.deployment ? host_.deployment->status() : types::DeploymentStatus{};
    if (to_pages) server_.toPages(status_stream, {"", toBytes(statusText(status, counts())), true});
    if (!to_foxglove) return;
    if (host_.deployment) sendTime(status.now);
    showParameters(status);
} catch (const std::exception& error) {
    std::lock_guard lock(mutex_);
    diagnostic_ = std::string("the state of the tasks cannot be shown: ") + error.what();
}

void Publisher::showParameters(const types::DeploymentStatus& status) {
    if (server_.parameterReaders() == 0) return reported_.clear();  // a new client receives all
    Parameters parameters = listParameters(status), changed;
    for (const auto& one : parameters)
        if (std::ranges::find(reported_, one) == reported_.end()) changed.push_back(one);
    reported_ = std::move(parameters);
    if (!changed.empty()) server_.parametersToFoxglove(std::move(changed));
}

// -- requests ---------------------------------------------------------------------------------------------------------

void Publisher::request(uint64_t client, std::string text) {
    Request request;
    try {
        readRequest(text, request);
    } catch (const std::exception& error) {
        return server_.reply(client, refusalText(request.id, error.what()));
    }
    if (!executors_.run(getTask(request.operation),
                        [this, client, request] { server_.reply(client, answer(request)); }))
        server_.reply(client, refusalText(request.id, "too many requests are waiting; try again later"));
}

/** Returns the task that is called; empty if there is none. */
std::string Publisher::getTask(const std::string& path) const {
    const std::string task = path.substr(0, path.find('.'));
    return std::ranges::find(tasks_, task, &types::TaskInterface::name) == tasks_.end() ? "" : task;
}

std::string Publisher::answer(const Request& request) const try {
    return answerText(request.id, carryOut(request));
} catch (const std::exception& error) {
    return refusalText(request.id, error.what());
}

void Publisher::parameters(uint64_t client, ParameterRequest request, bool may_set) {
    const std::string executor = request.values.empty() ? "" : getTask(request.values.front().first);
    const auto work = [this, client, request, may_set] {
        server_.reply(client, answerParameters(client, request, may_set));
    };
    if (!executors_.run(executor, work))
        server_.reply(client, diagnosticText("too many requests are waiting; try again later"));
}

/** Sets parameters, with a message for each refusal; then returns the present values. */
std::string Publisher::answerParameters(uint64_t client, const ParameterRequest& request, bool may_set) try {
    std::set<std::string> names(request.names.begin(), request.names.end());
    for (const auto& [name, yaml] : request.values) {
        names.insert(name);
        if (const std::string why = setParameter(name, yaml, may_set); !why.empty())
            server_.reply(client, diagnosticText(name + ": " + why));
    }
    Parameters all = host_.deployment ? listParameters(host_.deployment->status()) : Parameters{};
    if (!names.empty()) std::erase_if(all, [&](const auto& one) { return !names.contains(one.first); });
    return parameterValues(all, request.id);
} catch (const std::exception& error) {
    return diagnosticText(error.what());
}

/** Returns why the setting was refused, or an empty text. */
std::string Publisher::setParameter(const std::string& name, const std::string& yaml, bool may_set) const try {
    if (!may_set) throw std::runtime_error("a web site may set parameters only with the viewer's token");
    const std::string task = getTask(name);
    if (task.empty() || task.size() + 1 >= name.size()) throw std::runtime_error("is not a property of any task");
    std::string operation = name;
    operation.replace(task.size(), 2, std::string(".set") + types::raised(name[task.size() + 1]));
    Request request;
    request.operation = operation;
    request.arguments = {yaml};
    carryOut(request);
    return "";
} catch (const std::exception& error) {
    return error.what();
}

std::string Publisher::carryOut(const Request& request) const {
    if (!config_.control) throw std::runtime_error("this viewer is read-only (control: false)");
    if (!host_.deployment) throw std::runtime_error("this viewer is not part of a deployment");
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
    if (operation.starts_with(host_.viewer + ".")) throw std::runtime_error("the viewer does not control itself");
    if (std::ranges::any_of(life_cycle, [&](const char* ending) { return operation.ends_with(ending); }))
        throw std::runtime_error("only the deployment changes the states of tasks");
}

}  // namespace insonify::viewer
