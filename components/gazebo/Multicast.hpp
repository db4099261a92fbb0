#pragma once
#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/gazebo/TransportOptions.hpp"

namespace insonify::gazebo {

/** A descriptor that becomes readable when it is raised. */
class Alarm {
public:
    Alarm() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
    ~Alarm() { close(descriptor_); }
    Alarm(const Alarm&) = delete;
    Alarm& operator=(const Alarm&) = delete;

    int descriptor() const { return descriptor_; }
    void raise() const {
        const uint64_t one = 1;
        [[maybe_unused]] const auto written = write(descriptor_, &one, sizeof one);
    }
    void clear() const {
        uint64_t raised = 0;
        [[maybe_unused]] const auto count = read(descriptor_, &raised, sizeof raised);
    }

private:
    const int descriptor_;
};

/** Sends and receives datagrams of a multicast group on all networks of this machine, including loopback. Not
 *  thread-safe. */
class Multicast {
public:
    /** Throws types::ConfigError when no network supports multicast. */
    Multicast(const TransportOptions& options, uint16_t port);
    ~Multicast();
    Multicast(const Multicast&) = delete;
    Multicast& operator=(const Multicast&) = delete;

    /** Returns a descriptor for poll(); readable when a datagram has arrived. */
    int descriptor() const { return receiver_; }
    /** Sends on each network; ignores networks that are down. */
    void send(const std::string& datagram) const;

    struct Datagram {
        std::string bytes;
        bool is_from_here = false;  ///< From this machine.
    };
    /** Returns the next datagram that has arrived; none when all are read. Does not wait. */
    std::optional<Datagram> receive() const;

private:
    void close();

    uint32_t group_ = 0;  ///< Address, in network byte order.
    uint16_t port_ = 0;
    int receiver_ = -1;
    std::vector<int> senders_;         ///< One for each network.
    std::vector<uint32_t> addresses_;  ///< Addresses of this machine, in network byte order.
};

/** Returns this machine's address in the network of "tcp://ADDRESS:PORT". */
std::string addressTowards(const std::string& endpoint, const TransportOptions& options);

}  // namespace insonify::gazebo
