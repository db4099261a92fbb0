#pragma once
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/device/Bytes.hpp"

namespace insonify::device {

/** One way of asking whether a device is there. */
struct Probe {
    enum class Line { Udp, Tcp, Serial, Broadcast };

    std::string protocol;
    Line line;
    uint16_t port = 0;  ///< Where the device is found if nothing is said.
    Bytes question;     ///< Empty: it speaks by itself.
    /** What the device tells of itself, from all that has come so far; none: nothing yet. */
    std::function<std::optional<std::string>(std::span<const uint8_t>)> read;
    /** Why a driver waits for ever where this gets no answer. */
    std::string silence;
};

/** Every question that is known, each once for each line and usual port. A protocol is added by a function that reads
 *  its answers and a row here. */
std::vector<Probe> allProbes();

/** Where to ask: a host with or without a port, or a serial line. */
struct ProbeAddress {
    std::string host, serial;
    uint16_t port = 0;  ///< 0: every usual one.
};

/** "192.168.2.2", "sonar:9092", "[::1]:12345", "/dev/ttyUSB0". Throws types::ConfigError for what is none of these, and
 *  for hosts that are not known. */
ProbeAddress probeAddress(const std::string& text);

/** What came of one question. */
struct ProbeOutcome {
    std::string protocol, asked;  ///< "UDP 127.0.0.1:12345"
    std::string device;           ///< Empty: nothing answered.
    std::string failure;          ///< Why not, in words; then
    std::string advice;           ///< what may be the matter.
};

/** Asks one question for so long. Of what is broadcast only that counts which the address has sent, or which names the
 *  address as its own; ::1 is 127.0.0.1 there. */
ProbeOutcome ask(const Probe& probe, const ProbeAddress& address, std::chrono::milliseconds patience);

/** Asks all that can be asked at an address, each question for so long. */
std::vector<ProbeOutcome> probe(const ProbeAddress& address, std::chrono::milliseconds patience);

// What devices tell of themselves, by protocol; none where the bytes are not theirs.
std::optional<std::string> pingDeviceIn(std::span<const uint8_t> bytes);        ///< Ping360, Ping1D and their kin.
std::optional<std::string> ping360DiscoveryIn(std::span<const uint8_t> bytes);  ///< The text on UDP 30303.
std::optional<std::string> oculusIn(std::span<const uint8_t> bytes);            ///< Status, or what a connection gets.
std::optional<std::string> seaNetIn(std::span<const uint8_t> bytes);            ///< Tritech Micron, SeaKing.
std::optional<std::string> sonar3dIn(std::span<const uint8_t> bytes);           ///< HTTP of a Water Linked Sonar 3D-15.

}  // namespace insonify::device
