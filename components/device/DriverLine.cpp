#include "components/device/DriverLine.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <memory>
#include <utility>

namespace insonify::device {
namespace {

[[noreturn]] void fail(int error) { throw LineError(std::generic_category().message(error), error); }

struct Freed {
    void operator()(addrinfo* list) const { freeaddrinfo(list); }
};
using Addresses = std::unique_ptr<addrinfo, Freed>;

Addresses addresses(const std::string& host, uint16_t port, int type) {
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = type;
    if (const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found); error != 0)
        throw LineError(gai_strerror(error));
    return Addresses(found);
}

constexpr DriverLine::Duration max_sending{1000};

bool isReady(int file, short events, DriverLine::Duration patience) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + patience;
    pollfd ready{file, events, 0};
    int found = -1;
    do {  // again after a signal
        const auto left = std::chrono::ceil<DriverLine::Duration>(end - Clock::now());
        found = poll(&ready, 1, static_cast<int>(std::max<DriverLine::Duration::rep>(0, left.count())));
    } while (found < 0 && errno == EINTR);
    return found == 1;
}

/** Unprocessed bytes, at 115200 baud. */
void makeRaw(int file) {
    termios line{};
    if (tcgetattr(file, &line) != 0) fail(errno);
    cfmakeraw(&line);
    cfsetspeed(&line, B115200);
    line.c_cflag |= CLOCAL | CREAD;
    if (tcsetattr(file, TCSANOW, &line) != 0) fail(errno);
}

}  // namespace

DriverLine::DriverLine(DriverLine&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

DriverLine::~DriverLine() {
    if (file_ >= 0) close(file_);
}

DriverLine DriverLine::udp(const std::string& host, uint16_t port) {
    const Addresses to = addresses(host, port, SOCK_DGRAM);
    DriverLine line(socket(to->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    if (line.file_ < 0 || connect(line.file_, to->ai_addr, to->ai_addrlen) != 0) fail(errno);
    return line;
}

DriverLine DriverLine::tcp(const std::string& host, uint16_t port, Duration patience) {
    const Addresses to = addresses(host, port, SOCK_STREAM);
    DriverLine line(socket(to->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (line.file_ < 0) fail(errno);
    if (connect(line.file_, to->ai_addr, to->ai_addrlen) == 0) return line;
    if (errno != EINPROGRESS) fail(errno);
    if (!isReady(line.file_, POLLOUT, patience)) fail(ETIMEDOUT);
    int error = 0;
    socklen_t size = sizeof error;
    getsockopt(line.file_, SOL_SOCKET, SO_ERROR, &error, &size);
    if (error != 0) fail(error);
    return line;
}

DriverLine DriverLine::serial(const std::filesystem::path& file) {
    DriverLine line(open(file.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    if (line.file_ < 0) fail(errno);
    makeRaw(line.file_);
    return line;
}

DriverLine DriverLine::broadcasts(uint16_t port) {
    const Addresses at = addresses("0.0.0.0", port, SOCK_DGRAM);
    DriverLine line(socket(at->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    const int shared = 1;  // drivers may listen there as well
    setsockopt(line.file_, SOL_SOCKET, SO_REUSEADDR, &shared, sizeof shared);
    setsockopt(line.file_, SOL_SOCKET, SO_REUSEPORT, &shared, sizeof shared);
    if (line.file_ < 0 || bind(line.file_, at->ai_addr, at->ai_addrlen) != 0) fail(errno);
    return line;
}

void DriverLine::send(std::span<const uint8_t> bytes) const {
    while (!bytes.empty()) {
        ssize_t sent = ::send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == ENOTSOCK) sent = ::write(file_, bytes.data(), bytes.size());  // a serial line
        if (sent >= 0)
            bytes = bytes.subspan(static_cast<size_t>(sent));
        else if (errno == EAGAIN && !isReady(file_, POLLOUT, max_sending))
            fail(ETIMEDOUT);
        else if (errno != EAGAIN && errno != EINTR)
            fail(errno);
    }
}

Bytes DriverLine::receive(Duration patience) const {
    if (!isReady(file_, POLLIN, patience)) return {};
    Bytes bytes(65536);
    const ssize_t got = ::read(file_, bytes.data(), bytes.size());
    if (got < 0) fail(errno);
    if (got == 0) throw LineError("the other end has closed the line");
    bytes.resize(static_cast<size_t>(got));
    return bytes;
}

DriverLine::Datagram DriverLine::receiveDatagram(Duration patience) const {
    if (!isReady(file_, POLLIN, patience)) return {};
    Datagram datagram{Bytes(65536)};
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got =
        recvfrom(file_, datagram.bytes.data(), datagram.bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (got < 0) fail(errno);
    datagram.bytes.resize(static_cast<size_t>(got));
    datagram.from = std::bit_cast<Ipv4>(from.sin_addr.s_addr);
    return datagram;
}

std::vector<Ipv4> hostAddresses(const std::string& host) {
    std::vector<Ipv4> found;
    try {
        const Addresses all = addresses(host, 1, SOCK_DGRAM);
        for (const addrinfo* each = all.get(); each; each = each->ai_next)
            if (each->ai_family == AF_INET)
                found.push_back(
                    std::bit_cast<Ipv4>(reinterpret_cast<const sockaddr_in*>(each->ai_addr)->sin_addr.s_addr));
    } catch (const LineError&) {
        found.clear();
    }
    return found;
}

bool isKnownHost(const std::string& host) {
    try {
        addresses(host, 1, SOCK_DGRAM);
        return true;
    } catch (const LineError&) {
        return false;
    }
}

}  // namespace insonify::device
