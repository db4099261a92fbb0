#pragma once
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "components/device/wire/Bytes.hpp"

namespace insonify::device {

/** The reason why a line cannot be opened, or has broken. */
struct LineError : std::runtime_error {
    explicit LineError(const std::string& reason, int number = 0) : std::runtime_error(reason), error_number(number) {}
    int error_number;  ///< Of the system; 0: unknown.
};

/** A driver's end of a line to a device. No call takes longer than its time limit. */
class DriverLine {
public:
    using Duration = std::chrono::milliseconds;

    // Each throws LineError. `host` is numeric or a name.
    static DriverLine udp(const std::string& host, uint16_t port);
    static DriverLine tcp(const std::string& host, uint16_t port, Duration patience);
    static DriverLine serial(const std::filesystem::path& file);
    /** Receives broadcasts to a UDP port of this machine. */
    static DriverLine broadcasts(uint16_t port);

    DriverLine(DriverLine&& other) noexcept;
    ~DriverLine();
    DriverLine(const DriverLine&) = delete;
    DriverLine& operator=(const DriverLine&) = delete;
    DriverLine& operator=(DriverLine&&) = delete;

    /** Sends all bytes, within 1 s. Throws LineError. */
    void send(std::span<const uint8_t> bytes) const;
    /** Returns the next bytes, at most 64 KiB; empty: nothing has arrived. Throws LineError where the line is
     *  closed. */
    Bytes receive(Duration patience) const;
    /** A datagram of any sender, with the sender's address; no bytes: nothing has arrived. */
    struct Datagram {
        Bytes bytes;
        Ipv4 from{};
    };
    Datagram receiveDatagram(Duration patience) const;

private:
    explicit DriverLine(int file) : file_(file) {}
    int file_;
};

/** Whether this machine can resolve the host. */
bool isKnownHost(const std::string& host);
/** Returns the IPv4 addresses of a host; none for an unknown host. */
std::vector<Ipv4> hostAddresses(const std::string& host);

}  // namespace insonify::device
