#include "components/mavlink/PoseTask.hpp"

#include "types/text/ConfigError.hpp"

namespace insonify::mavlink {
namespace {

constexpr uint8_t our_system = 255, our_component = 190;  // those of a ground station
constexpr types::Time request_period{1'000'000};

std::string toText(const Frame& frame) {
    const char* name = frame.message == AttitudeQuaternion::kind.message ? AttitudeQuaternion::name
                       : frame.message == LocalPositionNed::kind.message ? LocalPositionNed::name
                                                                         : VisionPositionEstimate::name;
    return std::string(name) + " of system " + std::to_string(frame.system) + ", component " +
           std::to_string(frame.component);
}

}  // namespace

types::Notices PoseTask::notices() const {
    types::Notices all;
    if (network_)
        for (const std::string& end : network_->names()) all.push_back("listens on " + end);
    for (const auto* counted : {&drops_, &others_})
        for (std::string& line : counted->summary()) all.push_back(std::move(line));
    return all;
}

bool PoseTask::configureHook() {
    drops_.reset();
    others_.reset();
    network_ = std::make_unique<device::Network>([this] { arrived_.raise(); });
    try {
        network_->listenUdp(config->address, static_cast<uint16_t>(config->port));
    } catch (const device::NetworkError& error) {
        throw types::ConfigError("", name() + "." + error.property, error.what());
    }
    return true;
}

bool PoseTask::startHook() {
    network_->take();  // drops datagrams from before the start
    peers_.clear();
    requested_ = {};
    has_written_ = silence_is_reported_ = false;
    heard_.clear();
    outputs_.forEach([this](auto& output) {
        output.kept.body = std::make_unique<Body>(*findEntry(output.port.name()), config->origin);
    });
    return true;
}

void PoseTask::updateHook() {
    for (const device::NetworkEvent& event : network_->take()) take(event);
    if (config->request) request(now());
    if (const std::string reported = drops_.consumeWarning(); !reported.empty()) warn(reported);
    if (has_written_) return;
    if (const std::string reported = others_.consumeWarning(); !reported.empty()) warn(reported);
}

void PoseTask::take(const device::NetworkEvent& event) {
    using Happened = device::NetworkEvent::Kind;
    if (event.kind == Happened::Closed) peers_.erase(event.client);
    if (event.kind != Happened::Received) return;
    const Datagram datagram = readDatagram(event.bytes, received_kinds);
    if (!datagram.diagnostic.empty()) drops_.add(datagram.diagnostic);
    for (const Frame& frame : datagram.frames) take(frame, event.client);
}

void PoseTask::take(const Frame& frame, device::Client client) {
    if (frame.system != our_system) peers_.try_emplace(client, 0);
    bool is_wanted = false, is_of_one = false;
    outputs_.forEach([&](auto& output) {
        is_wanted |= output.kept.body->wants(frame.message);
        if (!output.kept.body->isInPart(frame)) return;
        is_of_one = true;
        const Body::Taken taken = output.kept.body->take(frame, client.number, now());
        if (!taken.diagnostic.empty()) drops_.add(output.port.name() + ": " + taken.diagnostic);
        if (!taken.pose) return;
        has_written_ = true;
        output.port.write(*taken.pose);
    });
    if (is_wanted && !is_of_one) others_.add(toText(frame));
    if (frame.message == Heartbeat::kind.message && !has_written_ && !silence_is_reported_ && others_.summary().empty())
        noteSilence(frame.system, frame.component);
}

void PoseTask::noteSilence(uint8_t system, uint8_t component) {
    constexpr types::Time patience{5'000'000};
    bool is_ours = false;
    outputs_.forEach([&](auto& output) {
        const Body& body = *output.kept.body;
        is_ours |= body.config().system_id == system && body.missing(now()).size() == 2 &&
                   body.config().component_id.value_or(component) == component;
    });
    if (!is_ours) return;
    const types::Time first = heard_.try_emplace(system, now()).first->second;
    silence_is_reported_ = types::elapsed(first, now()) > patience;
    if (silence_is_reported_)
        warn("system " + std::to_string(system) + " sends HEARTBEAT, but neither " + AttitudeQuaternion::name +
             " nor " + LocalPositionNed::name +
             (config->request ? ", although they are requested" : "; set `request`, or the rates of its streams"));
}

void PoseTask::request(types::Time now) {
    if (types::elapsed(requested_, now) < request_period) return;
    requested_ = now;
    for (const auto& [client, sequence] : peers_) {
        send(Heartbeat{.type = 6, .autopilot = 8, .system_status = 4}, client);  // ground station, no autopilot, active
        outputs_.forEach([&](auto& output) { requestFor(*output.kept.body, client, now); });
    }
}

void PoseTask::requestFor(const Body& body, device::Client client, types::Time now) {
    for (const uint32_t message : body.missing(now)) {
        CommandLong command{.command = CommandLong::set_message_interval};
        command.parameters[0] = static_cast<float>(message);
        command.parameters[1] = static_cast<float>(1e6 / config->request->rate);
        command.target_system = static_cast<uint8_t>(body.config().system_id);
        command.target_component =
            static_cast<uint8_t>(body.config().component_id.value_or(1));  // that of an autopilot
        send(command, client);
    }
}

template <class Message>
void PoseTask::send(const Message& message, device::Client client) {
    const Frame frame = getFrame(message, our_system, our_component, peers_[client]++);
    network_->send(client, frame.bytes(Message::kind.crc_extra));
}

void PoseTask::cleanupHook() {
    outputs_.forEach([](auto& output) { output.kept.body.reset(); });
    network_.reset();
}

void registerTasks(framework::Registry& registry) {
    registry.add<PoseTask>("mavlink::PoseTask", "reads the poses of vehicles that autopilots send by MAVLink");
}

}  // namespace insonify::mavlink
