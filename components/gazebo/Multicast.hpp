#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/gazebo/TransportOptions.hpp"

namespace insonify::gazebo {

/** The datagrams of a multicast group, by all networks of this machine, its own included. Not for several threads. */
class Multicast {
public:
    /** Throws types::ConfigError where no network takes part. */
    Multicast(const TransportOptions& options, uint16_t port);
    ~Multicast();
    Multicast(const Multicast&) = delete;
    Multicast& operator=(const Multicast&) = delete;

    /** To wait on until it can be read. */
    int descriptor() const { return receiver_; }
    /** By each network; one that is down at the moment is passed over. */
    void send(const std::string& datagram) const;

    struct Datagram {
        std::string bytes;
        bool is_from_here = false;  ///< From this machine.
    };
    /** Returns the next datagram that has come; none where all are read. Does not wait. */
    std::optional<Datagram> receive() const;

private:
    void close();

    uint32_t group_ = 0;  ///< Address, in the order of networks.
    uint16_t port_ = 0;
    int receiver_ = -1;
    std::vector<int> senders_;         ///< One for each network.
    std::vector<uint32_t> addresses_;  ///< This machine's, in the order of networks.
};

/** Returns this machine's address in the network of "tcp://ADDRESS:PORT". */
std::string addressTowards(const std::string& endpoint, const TransportOptions& options);

}  // namespace insonify::gazebo
