#pragma once
#include <chrono>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "components/device/wire/Bytes.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::device {

/** An end that clients connect to: its index in the Network, in the order of opening. */
using End = size_t;

/** A peer of the device: a TCP connection, the address of a datagram, or the user of the serial line. */
struct Client {
    End end = 0;
    uint64_t number = 0;  ///< Unique at its end; never used again.
    auto operator<=>(const Client&) const = default;
};

/** An event at an end. */
struct NetworkEvent {
    enum class Kind { Opened, Received, Closed };
    Kind kind;
    Client client;
    Bytes bytes;       ///< Received: the available bytes of a stream, or one whole datagram.
    std::string peer;  ///< Opened: the client's address.
};

/** The reason why an end cannot be opened, to be printed after the property that names the end. */
struct NetworkError : std::runtime_error {
    NetworkError(std::string of, const std::string& why) : std::runtime_error(why), property(std::move(of)) {}
    std::string property;  ///< address, port or serial.
};

/** Reports a property `address` that is no numeric address, before anything is opened. */
void checkAddress(types::Diagnostics& diagnostics, const std::string& address);

/** Moves bytes between clients and one task on its own thread, so that no client delays the task.
 *
 *  All buffers are bounded. A client that sends faster than the task reads is not read meanwhile (datagrams are lost).
 *  A client that does not read its replies is disconnected. All functions are called on one thread, that of the
 *  task. */
class Network {
public:
    static constexpr size_t max_clients = 64;        ///< Max clients of an end; the next replaces the longest silent.
    static constexpr size_t max_received = 1 << 20;  ///< With their events; beyond, clients are not read [bytes].
    static constexpr size_t max_replies = size_t{8} << 20;  ///< Waiting for one client; beyond, it is closed [bytes].
    static constexpr size_t max_line = 4096;  ///< Waiting for a serial line; beyond, the oldest are dropped [bytes].

    /** Reply: delivered, in order. Stream: only the newest waits, behind all replies. */
    enum class Kind { Reply, Stream };

    /** Calls `wake` on another thread when there is an event, and when wakeAt() is due. */
    explicit Network(std::function<void()> wake);
    ~Network();
    Network(const Network&) = delete;
    Network& operator=(const Network&) = delete;

    // Each throws NetworkError. Port 0 selects a free port.
    End listenTcp(const std::string& address, uint16_t port);
    End listenUdp(const std::string& address, uint16_t port);
    /** Opens a pseudo terminal in place of a serial line; `link` points to the side that drivers open, and is removed
     *  with the end.
     *
     *  A line does not show whether a driver has opened it. Unread bytes are therefore kept as for a slow driver:
     *  `max_line` here, in addition to the terminal's own buffer (about 16 KiB). Beyond that, the oldest bytes of both
     *  are lost, which may cut a packet. A driver that opens the line reads these few old bytes before the newest. */
    End openSerial(const std::filesystem::path& link);
    uint16_t getPort(End end) const;  ///< 0: the end has no port.
    /** Returns every end, as "TCP 127.0.0.1:52100" or "serial line /tmp/sonar". */
    std::vector<std::string> names() const;

    /** Returns the events since the last call, in order. */
    std::vector<NetworkEvent> take();
    /** Sends bytes to a client; does nothing if the client is gone. */
    void send(Client client, Bytes bytes, Kind kind = Kind::Reply);
    /** Sends one datagram, also to a broadcast or multicast group; it is lost without a route. Throws NetworkError if
     *  the address is invalid. */
    void sendTo(const std::string& address, uint16_t port, Bytes bytes);
    /** Closes a connection once all replies have been sent. A Closed event follows. */
    void close(Client client);
    void wakeAt(std::chrono::steady_clock::time_point when);
    /** Messages dropped: replaced by newer messages, or no route to the receiver [1]. */
    uint64_t dropped() const;
    /** Connections closed for newer connections at max_clients [1]. */
    uint64_t displaced() const;
    /** Failures on the network's thread, each followed by normal operation: out of memory, an exception of `wake`
     *  [1]. */
    uint64_t failures() const;

    class Core;

private:
    std::unique_ptr<Core> core_;
};

}  // namespace insonify::device
