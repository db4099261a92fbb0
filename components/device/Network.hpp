#pragma once
#include <chrono>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "components/device/Bytes.hpp"

namespace insonify::device {

/** A place where clients come: of its Network, in the order in which they were opened. */
using End = size_t;

/** One who talks to the device: a TCP connection, the address of a datagram, or whoever holds the serial line. */
struct Client {
    End end = 0;
    uint64_t number = 0;  ///< Of its end; never used again.
    auto operator<=>(const Client&) const = default;
};

/** What has happened at an end. */
struct NetworkEvent {
    enum class Kind { Opened, Received, Closed };
    Kind kind;
    Client client;
    Bytes bytes;       ///< Received: of a stream whatever has come, of datagrams a whole one.
    std::string peer;  ///< Opened: its address.
};

/** An end that cannot be opened: why, to be said after the property that names it. */
struct NetworkError : std::runtime_error {
    NetworkError(std::string of, const std::string& why) : std::runtime_error(why), property(std::move(of)) {}
    std::string property;  ///< address, port or serial.
};

/** Moves bytes between clients and one task, on a thread of its own, so that no client holds up the task.
 *
 *  Everything is bounded: a client that sends faster than the task takes is not read meanwhile (datagrams are lost),
 * and one that does not read what must arrive is closed. All functions are for one thread, that of the task. */
class Network {
public:
    static constexpr size_t max_clients = 64;        ///< Of an end; for one more, the longest silent goes.
    static constexpr size_t max_received = 1 << 20;  ///< With their events, before clients are read no more [bytes].
    static constexpr size_t max_replies = size_t{8} << 20;  ///< That wait for one client, before it is closed [bytes].
    static constexpr size_t max_line = 4096;  ///< Replies that wait for a serial line, before the oldest go [bytes].

    /** Reply: arrives, in order. Stream: of these only the newest waits, behind all replies. */
    enum class Kind { Reply, Stream };

    /** `wake` is called on another thread when something has happened, and when wakeAt() is due. */
    explicit Network(std::function<void()> wake);
    ~Network();
    Network(const Network&) = delete;
    Network& operator=(const Network&) = delete;

    // Each throws NetworkError. Port 0 is any that is free.
    End listenTcp(const std::string& address, uint16_t port);
    End listenUdp(const std::string& address, uint16_t port);
    /** A pseudo terminal in place of a serial line; `link` leads to the side that drivers open, and goes with the end.
     *
     *  A line does not tell whether a driver has it open, so what nobody reads is kept as if one were slow: `max_line`
     *  here, beside what the terminal itself holds (about 16 KiB). Where more comes, the oldest of both is lost, which
     *  may cut a packet; a driver that opens the line reads that little of the past before the newest. */
    End openSerial(const std::filesystem::path& link);
    uint16_t portOf(End end) const;  ///< 0: it has none.
    /** Every end, as "TCP 127.0.0.1:52100" or "serial line /tmp/sonar". */
    std::vector<std::string> names() const;

    /** What has happened since the last call, in order. */
    std::vector<NetworkEvent> take();
    /** To a client that is gone: nothing. */
    void send(Client client, Bytes bytes, Kind kind = Kind::Reply);
    /** One datagram, to a broadcast or multicast group as well; lost where there is no way. Throws NetworkError where
     * the address is none. */
    void sendTo(const std::string& address, uint16_t port, Bytes bytes);
    /** Once all replies have been sent. There will be a Closed event. */
    void close(Client client);
    void wakeAt(std::chrono::steady_clock::time_point when);
    /** Messages that were not sent: newer ones took their place, or there was no way [1]. */
    uint64_t dropped() const;
    /** Connections that were closed for newer ones, max_clients being there [1]. */
    uint64_t displaced() const;
    /** Failures on the network's thread, after each of which it has gone on: no memory, an exception of `wake` [1]. */
    uint64_t failures() const;

    class Core;

private:
    std::unique_ptr<Core> core_;
};

}  // namespace insonify::device
