#include "components/device/ping/Ping360Task.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <string_view>

namespace insonify::device {
namespace {

/** Parses "02-00-00-00-03-60"; none for other texts. */
std::optional<std::array<uint8_t, 6>> readMac(const std::string& text) {
    std::array<uint8_t, 6> parts{};
    const char* at = text.c_str();
    for (size_t i = 0; i < parts.size(); ++i) {
        char* end = nullptr;
        if (!std::isxdigit(static_cast<unsigned char>(*at))) return {};
        const unsigned long part = std::strtoul(at, &end, 16);
        if (end == at || part > 255 || *end != (i + 1 < parts.size() ? '-' : '\0')) return {};
        parts[i] = static_cast<uint8_t>(part);
        at = end + 1;
    }
    return parts;
}

}  // namespace

void Ping360Discovery::check(types::Diagnostics& diagnostics) const {
    if (!ipv4(ip)) diagnostics.push_back({"ip", "is '" + ip + "'; write it as 192.168.2.10"});
    if (!readMac(mac)) diagnostics.push_back({"mac", "is '" + mac + "'; write it as 02-00-00-00-03-60"});
}

std::string Ping360Discovery::answer() const {
    return ping360Discovery(readMac(mac).value_or(std::array<uint8_t, 6>{}), ipv4(ip).value_or(Ipv4{}));
}

void Ping360Task::listen(Network& network) {
    PingDeviceTask::listen(network);
    finders_.reset();
    if (config->discovery) finders_ = network.listenUdp("0.0.0.0", static_cast<uint16_t>(config->discovery->port));
}

void Ping360Task::received(Client client, std::span<const uint8_t> bytes) {
    if (client.end != finders_) return PingDeviceTask::received(client, bytes);
    constexpr std::string_view question = "Discovery";
    if (bytes.size() < question.size() || !std::equal(question.begin(), question.end(), bytes.begin())) return;
    const std::string answer = config->discovery->answer();
    network().send(client, Bytes(answer.begin(), answer.end()));
}

}  // namespace insonify::device
