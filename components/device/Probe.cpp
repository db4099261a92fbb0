#include "components/device/Probe.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <set>
#include <string_view>

#include "components/device/DriverLine.hpp"
#include "components/device/micron/SeaNet.hpp"
#include "components/device/oculus/OculusEmulator.hpp"
#include "components/device/ping/PingProtocol.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::device {
namespace {

using Clock = std::chrono::steady_clock;

std::string_view toText(std::span<const uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Bytes toBytes(std::string_view text) { return {text.begin(), text.end()}; }

std::string getName(uint8_t ping_device) {
    switch (static_cast<PingDeviceType>(ping_device)) {
        case PingDeviceType::Ping1d: return "Blue Robotics Ping1D";
        case PingDeviceType::Ping360: return "Blue Robotics Ping360";
        default: return fmt::format("device of type {} of the ping protocol", ping_device);
    }
}

/** Returns "M750d", as its maker writes it. */
std::string oculusName(uint16_t part) {
    const auto model = oculusModel(part);
    if (!model) return fmt::format("of part {}", part);
    std::string name(types::EnumNames<OculusModel>::names[static_cast<size_t>(*model)]);
    name.front() = 'M';
    return name;
}

Bytes pingQuestion() {
    Bytes question = pingBytes(PingGeneralRequest{PingDeviceInformation::message});
    const Bytes second = pingBytes(PingGeneralRequest{PingProtocolVersion::message});
    question.insert(question.end(), second.begin(), second.end());
    return question;
}

constexpr const char* nobody_there =
    "nothing listens there: the device or its deployment does not run, its `port` is another, or its `address` is "
    "127.0.0.1 and you ask from another machine";
constexpr const char* no_line =
    "the line cannot be opened: the adapter is not plugged in, its path is another (`ls /dev/serial/by-id`), this user "
    "may not use it (group dialout), or the deployment that makes the path does not run";
constexpr const char* port_is_taken = "another program of this machine listens to these broadcasts: stop it";
constexpr const char* lost_on_the_way =
    "a datagram was lost on the way: another address or port, a firewall, or a device of another kind";

void addPing(std::vector<Probe>& all) {
    const char* const protocol = "ping protocol (Ping360, Ping1D)";
    for (const uint16_t port : {12345, 9092, 9090})
        all.push_back({protocol, Probe::Line::Udp, port, pingQuestion(), pingDeviceIn, lost_on_the_way});
    for (const uint16_t port : {12345, 9090})
        all.push_back({protocol, Probe::Line::Tcp, port, pingQuestion(), pingDeviceIn,
                       "it is connected, and does not speak the ping protocol"});
    all.push_back({protocol, Probe::Line::Serial, 0, pingQuestion(), pingDeviceIn,
                   "nothing answers at 115200 baud: another baud rate, another program that holds the line, crossed "
                   "wires, or a device of another kind"});
    all.push_back({"discovery of a Ping360", Probe::Line::Udp, 30303, toBytes("Discovery"), ping360DiscoveryIn,
                   "finders do not see it; a simulated device answers only with `discovery` in its properties"});
}

void addOculus(std::vector<Probe>& all) {
    all.push_back(
        {"Oculus status",
         Probe::Line::Broadcast,
         52102,
         {},
         oculusIn,
         "no status is broadcast: drivers that find an Oculus by it wait forever; broadcasts cross no router, "
         "and a firewall must let UDP 52102 in"});
    all.push_back({"Oculus",
                   Probe::Line::Tcp,
                   52100,
                   {},
                   oculusIn,
                   "it is connected and silent: in standby until a driver sends fire messages, or no Oculus"});
}

void addSeaNet(std::vector<Probe>& all) {
    const char* const silence =
        "no version arrives: a driver that waits for mtAlive or mtVersionData waits forever; the sonar's node is not "
        "2, "
        "or "
        "it is no Micron";
    all.push_back({"SeaNet (Micron)", Probe::Line::Tcp, 4001, seaNetRequest(SeaNetType::SendVersion).packet(), seaNetIn,
                   silence});
    all.push_back({"SeaNet (Micron)", Probe::Line::Serial, 0, seaNetRequest(SeaNetType::SendVersion).packet(), seaNetIn,
                   silence});
}

void addSonar3d(std::vector<Probe>& all) {
    const std::string question = "GET /api/v1/integration/about HTTP/1.1\r\nHost: sonar\r\nConnection: close\r\n\r\n";
    for (const uint16_t port : {80, 8080, 8015})  // the maker's, and the port of deploy/hil_3d15.yml
        all.push_back({"HTTP (Sonar 3D-15)", Probe::Line::Tcp, port, toBytes(question), sonar3dIn,
                       "what answers is no Sonar 3D-15, or firmware before 1.7.1"});
}

uint16_t portFor(const Probe& probe, const ProbeAddress& address) {
    return address.port != 0 && probe.line != Probe::Line::Broadcast ? address.port : probe.port;
}

DriverLine lineFor(const Probe& probe, const ProbeAddress& address, std::chrono::milliseconds patience) {
    const uint16_t port = portFor(probe, address);
    switch (probe.line) {
        case Probe::Line::Udp: return DriverLine::udp(address.host, port);
        case Probe::Line::Tcp: return DriverLine::tcp(address.host, port, patience);
        case Probe::Line::Serial: return DriverLine::serial(address.serial);
        case Probe::Line::Broadcast: return DriverLine::broadcasts(port);
    }
    throw LineError("there is no such line");
}

/** Returns why a line could not be opened, or why it refused the question. */
const char* getAdvice(Probe::Line line) {
    switch (line) {
        case Probe::Line::Serial: return no_line;
        case Probe::Line::Broadcast: return port_is_taken;
        default: return nobody_there;
    }
}

std::string getName(const Probe& probe, const ProbeAddress& address) {
    const uint16_t port = portFor(probe, address);
    const std::string host = address.host.find(':') == std::string::npos ? address.host : "[" + address.host + "]";
    switch (probe.line) {
        case Probe::Line::Udp: return fmt::format("UDP {}:{}", host, port);
        case Probe::Line::Tcp: return fmt::format("TCP {}:{}", host, port);
        case Probe::Line::Serial: return "serial line " + address.serial;
        case Probe::Line::Broadcast: return fmt::format("broadcasts to UDP {}", port);
    }
    return "";
}

/** Sends the question and reads until the device has identified itself. */
std::optional<std::string> converse(const Probe& probe, const DriverLine& line, std::chrono::milliseconds patience) {
    if (!probe.question.empty()) line.send(probe.question);
    Bytes received;
    const auto end = Clock::now() + patience;
    while (Clock::now() < end && received.size() < (1 << 20)) {
        const Bytes more = line.receive(std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()));
        received.insert(received.end(), more.begin(), more.end());
        if (auto device = probe.read(received)) return device;
    }
    return {};
}

/** Whether a datagram is from a device at one of these addresses. */
bool isInPart(const DriverLine::Datagram& datagram, const std::vector<Ipv4>& addresses) {
    const auto has = [&](const Ipv4& address) { return std::ranges::find(addresses, address) != addresses.end(); };
    const auto status = oculusStatus(datagram.bytes);
    return has(datagram.from) || (status && has(status->address));
}

/** Listens until the device at this host has identified itself; ignores other devices. */
std::optional<std::string> overhear(const Probe& probe, const DriverLine& line, const std::string& host,
                                    std::chrono::milliseconds patience) {
    const std::vector<Ipv4> addresses = hostAddresses(host == "::1" ? "127.0.0.1" : host);
    const auto end = Clock::now() + patience;
    while (Clock::now() < end) {
        const auto received =
            line.receiveDatagram(std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()));
        if (!isInPart(received, addresses)) continue;
        if (auto device = probe.read(received.bytes)) return device;
    }
    return {};
}

bool canAsk(const Probe& probe, const ProbeAddress& address) {
    return (probe.line == Probe::Line::Serial) == !address.serial.empty();
}

/** Returns one probe per line, where a port is given. */
std::vector<Probe> questionsFor(const ProbeAddress& address) {
    std::vector<Probe> request;
    for (Probe& probe : allProbes()) {
        const auto same = [&](const Probe& other) {
            return other.protocol == probe.protocol && other.line == probe.line && address.port != 0;
        };
        const bool elsewhere = address.port != 0 && probe.line == Probe::Line::Broadcast;
        if (canAsk(probe, address) && !elsewhere && std::ranges::none_of(request, same))
            request.push_back(std::move(probe));
    }
    return request;
}

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
    throw types::ConfigError(
        "", "ADDRESS", fmt::format("is '{}', {}; write a host, host:port, or the path of a serial line", text, why));
}

uint16_t getPort(const std::string& text, std::string_view digits) {
    uint16_t port = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    if (error != std::errc() || end != digits.data() + digits.size() || port == 0)
        refuse(text, fmt::format("whose port '{}' is not from 1 to 65535", digits));
    return port;
}

}  // namespace

std::optional<std::string> pingDeviceIn(std::span<const uint8_t> bytes) {
    std::optional<std::string> device, version;
    for (const PingFrame& frame : pingFrames(bytes, 4096)) {
        if (const auto about = pingMessage<PingDeviceInformation>(frame))
            device = fmt::format("{}, id {}, revision {}, firmware {}.{}.{}", getName(about->type), frame.source,
                                 about->revision, about->major, about->minor, about->patch);
        if (const auto spoken = pingMessage<PingProtocolVersion>(frame))
            version = fmt::format(", protocol {}.{}.{}", spoken->major, spoken->minor, spoken->patch);
    }
    if (!device || !version) return {};
    return *device + *version;
}

std::optional<std::string> ping360DiscoveryIn(std::span<const uint8_t> bytes) {
    std::string text(toText(bytes));
    if (!text.starts_with("SONAR PING360")) return {};
    for (size_t at; (at = text.find("\r\n")) != std::string::npos;)
        text.replace(at, 2, at + 2 < text.size() ? ", " : "");
    return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }) ? std::optional(text)
                                                                                              : std::nullopt;
}

std::optional<std::string> oculusIn(std::span<const uint8_t> bytes) {
    if (const auto status = oculusStatus(bytes)) {
        const bool runs = (status->status & 7) == OculusStatus::running;
        return fmt::format("Blueprint Subsea Oculus {}, at {}, {}", oculusName(status->part),
                           fmt::join(status->address, "."), runs ? "running" : "not ready: drivers may give up");
    }
    const auto header = oculusHeader(bytes);
    if (!header) return {};
    if (header->is(OculusId::Dummy)) return fmt::format("Blueprint Subsea Oculus {}, alive", oculusName(header->part));
    return fmt::format("Blueprint Subsea Oculus {}, message 0x{:02x}", oculusName(header->part), header->id);
}

std::optional<std::string> seaNetIn(std::span<const uint8_t> bytes) {
    SeaNetReader reader;
    reader.add(bytes);
    while (const auto message = reader.next()) {
        if (const auto version = SeaNetVersion::in(*message))
            return fmt::format("Tritech SeaNet device, node {}, software {}, serial number {}", message->from,
                               version->software, version->serial);
        if (SeaNetAlive::in(*message)) return fmt::format("Tritech SeaNet device, node {}, alive", message->from);
    }
    return {};
}

std::optional<std::string> sonar3dIn(std::span<const uint8_t> bytes) {
    const std::string_view text = toText(bytes);
    const std::string_view key = "\"version_short\"";
    if (!text.starts_with("HTTP/1.") || text.find("}") == std::string_view::npos) return {};
    const size_t at = text.find(key);
    if (at == std::string_view::npos) return {};
    const size_t begin = text.find('"', at + key.size()), end = text.find('"', begin + 1);
    if (begin == std::string_view::npos || end == std::string_view::npos) return {};
    return fmt::format("Water Linked Sonar 3D-15, version {}", text.substr(begin + 1, end - begin - 1));
}

std::vector<Probe> allProbes() {
    std::vector<Probe> all;
    addPing(all);
    addOculus(all);
    addSeaNet(all);
    addSonar3d(all);
    return all;
}

ProbeAddress probeAddress(const std::string& text) {
    ProbeAddress address;
    if (text.find('/') != std::string::npos) {
        std::error_code none;
        const auto type = std::filesystem::status(text, none).type();
        if (type != std::filesystem::file_type::character && type != std::filesystem::file_type::not_found)
            refuse(text, "which is no serial line");
        address.serial = text;
        return address;
    }
    const size_t colon = text.rfind(':');
    const bool bracketed = text.starts_with('['),
               has_port = colon != std::string::npos && (bracketed ? text[colon - 1] == ']' : text.find(':') == colon);
    address.host = has_port ? text.substr(0, colon) : text;
    if (has_port) address.port = getPort(text, std::string_view(text).substr(colon + 1));
    if (bracketed && address.host.ends_with(']')) address.host = address.host.substr(1, address.host.size() - 2);
    if (address.host.empty()) refuse(text, "which names no host");
    if (!isKnownHost(address.host)) refuse(text, "a host that this machine does not know");
    return address;
}

ProbeOutcome ask(const Probe& probe, const ProbeAddress& address, std::chrono::milliseconds patience) {
    ProbeOutcome outcome{probe.protocol, getName(probe, address), "", "", ""};
    bool may_be_there = false;
    try {
        const DriverLine line = lineFor(probe, address, patience);
        may_be_there = true;
        const bool overhears = probe.line == Probe::Line::Broadcast;
        const auto device = overhears ? overhear(probe, line, address.host, patience) : converse(probe, line, patience);
        outcome.device = device.value_or("");
        if (outcome.device.empty()) outcome.failure = "no answer";
    } catch (const LineError& error) {
        outcome.failure = error.what();
        may_be_there = may_be_there && error.error_number != ECONNREFUSED;
    }
    if (!outcome.failure.empty()) outcome.advice = may_be_there ? probe.silence : getAdvice(probe.line);
    return outcome;
}

std::vector<ProbeOutcome> probe(const ProbeAddress& address, std::chrono::milliseconds patience) {
    std::vector<ProbeOutcome> outcomes;
    std::set<std::string> answered;  // lines whose device has identified itself; they get no further probes
    for (const Probe& question : questionsFor(address)) {
        if (answered.contains(getName(question, address))) continue;
        outcomes.push_back(ask(question, address, patience));
        if (!outcomes.back().device.empty()) answered.insert(outcomes.back().request);
    }
    return outcomes;
}

}  // namespace insonify::device
