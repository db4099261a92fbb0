#include "components/gazebo/Multicast.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "types/text/ConfigError.hpp"

namespace insonify::gazebo {
namespace {

sockaddr_in getPlace(uint32_t address, uint16_t port) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = address;
    place.sin_port = htons(port);
    return place;
}

/** Returns the IPv4 addresses of this machine in networks that are up. */
std::vector<uint32_t> ownAddresses() {
    std::vector<uint32_t> addresses;
    ifaddrs* first = nullptr;
    if (getifaddrs(&first) != 0) return addresses;
    for (const ifaddrs* each = first; each; each = each->ifa_next) {
        if (!each->ifa_addr || each->ifa_addr->sa_family != AF_INET || !(each->ifa_flags & IFF_UP)) continue;
        if (!(each->ifa_flags & (IFF_MULTICAST | IFF_LOOPBACK))) continue;
        sockaddr_in place{};
        std::memcpy(&place, each->ifa_addr, sizeof place);
        if (std::ranges::count(addresses, place.sin_addr.s_addr) == 0) addresses.push_back(place.sin_addr.s_addr);
    }
    freeifaddrs(first);
    return addresses;
}

template <class Value>
bool set(int socket, int level, int option, const Value& value) {
    return setsockopt(socket, level, option, &value, sizeof value) == 0;
}

uint32_t getNumber(const std::string& address, const char* variable) {
    in_addr number{};
    if (inet_pton(AF_INET, address.c_str(), &number) != 1)
        throw types::ConfigError("", "",
                                 fmt::format("the environment variable GZ_{} or IGN_{} is \"{}\"; must be an address "
                                             "such as 192.168.1.7",
                                             variable, variable, address));
    return number.s_addr;
}

}  // namespace

Multicast::Multicast(const TransportOptions& options, uint16_t port)
    : group_(getNumber(options.group, "DISCOVERY_MULTICAST_IP")), port_(port), addresses_(ownAddresses()) {
    const std::vector<uint32_t> networks =
        options.ip.empty() ? addresses_ : std::vector<uint32_t>{getNumber(options.ip, "IP")};
    receiver_ = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    set(receiver_, SOL_SOCKET, SO_REUSEADDR, 1);
    set(receiver_, SOL_SOCKET, SO_REUSEPORT, 1);
    const sockaddr_in any = getPlace(htonl(INADDR_ANY), port);
    if (receiver_ < 0 || bind(receiver_, reinterpret_cast<const sockaddr*>(&any), sizeof any) != 0) {
        const std::string why = std::strerror(errno);
        close();
        throw types::ConfigError("", "",
                                 fmt::format("UDP port {} of Gazebo's discovery cannot be listened to: {}", port, why));
    }
    for (const uint32_t network : networks) {
        const int sender = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        const bool takes_part = sender >= 0 && set(sender, IPPROTO_IP, IP_MULTICAST_IF, in_addr{network}) &&
                                set(receiver_, IPPROTO_IP, IP_ADD_MEMBERSHIP, ip_mreq{{group_}, {network}});
        if (takes_part)
            senders_.push_back(sender);
        else if (sender >= 0)
            ::close(sender);
    }
    if (!senders_.empty()) return;
    close();
    throw types::ConfigError(
        "", "",
        options.ip.empty() ? "no network of this machine takes part in multicast, which Gazebo's discovery needs"
                           : fmt::format("the environment variable GZ_IP or IGN_IP is \"{}\", which is no address "
                                         "of this machine",
                                         options.ip));
}

Multicast::~Multicast() { close(); }

void Multicast::close() {
    for (const int sender : senders_) ::close(sender);
    if (receiver_ >= 0) ::close(receiver_);
}

void Multicast::send(const std::string& datagram) const {
    const sockaddr_in to = getPlace(group_, port_);
    for (const int sender : senders_)
        sendto(sender, datagram.data(), datagram.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to),
               sizeof to);
}

std::optional<Multicast::Datagram> Multicast::receive() const {
    std::array<char, 65536> buffer;
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t count =
        recvfrom(receiver_, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (count < 0) return {};
    return Datagram{{buffer.data(), static_cast<size_t>(count)},
                    std::ranges::count(addresses_, from.sin_addr.s_addr) > 0};
}

std::string addressTowards(const std::string& endpoint, const TransportOptions& options) {
    if (!options.ip.empty()) return options.ip;
    const size_t begin = endpoint.find("://"), end = endpoint.rfind(':');
    in_addr peer{};
    if (begin == std::string::npos || end < begin + 3 ||
        inet_pton(AF_INET, endpoint.substr(begin + 3, end - begin - 3).c_str(), &peer) != 1)
        return "127.0.0.1";
    const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const sockaddr_in to = getPlace(peer.s_addr, 9);  // nothing is sent
    sockaddr_in own{};
    socklen_t size = sizeof own;
    const bool is_known = connect(probe, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0 &&
                          getsockname(probe, reinterpret_cast<sockaddr*>(&own), &size) == 0;
    ::close(probe);
    char text[INET_ADDRSTRLEN] = {};
    if (!is_known || !inet_ntop(AF_INET, &own.sin_addr, text, sizeof text)) return "127.0.0.1";
    return text;
}

}  // namespace insonify::gazebo
