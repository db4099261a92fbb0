#pragma once
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/device/wire/Bytes.hpp"

namespace insonify::device {

/** One method to find out whether a device is there. */
struct Probe {
    enum class Line { Udp, Tcp, Serial, Broadcast };

    std::string protocol;
    Line line;
    uint16_t port = 0;  ///< Default port of the device.
    Bytes question;     ///< Empty: the device sends by itself.
    /** Returns the device's description of itself, from all bytes received so far; none: not yet. */
    std::function<std::optional<std::string>(std::span<const uint8_t>)> read;
    /** Why a driver would wait forever without this answer. */
    std::string silence;
};

/** Returns every known probe, once for each line and usual port. To add a protocol, add a function that reads its
 *  answers and a row here. */
std::vector<Probe> allProbes();

/** The address to probe: a host with or without a port, or a serial line. */
struct ProbeAddress {
    std::string host, serial;
    uint16_t port = 0;  ///< 0: all usual ports.
};

/** Parses "192.168.2.2", "sonar:9092", "[::1]:12345", "/dev/ttyUSB0". Throws types::ConfigError for other texts, and
 *  for unknown hosts. */
ProbeAddress probeAddress(const std::string& text);

/** The result of one probe. */
struct ProbeOutcome {
    std::string protocol, request;  ///< "UDP 127.0.0.1:12345"
    std::string device;             ///< Empty: no answer.
    std::string failure;            ///< The reason of no answer; then
    std::string advice;             ///< a possible cause.
};

/** Probes an address until an answer or the end of `patience`. Of broadcasts, only those count that the address sent or
 *  that name the address as their own; ::1 is 127.0.0.1 there. */
ProbeOutcome ask(const Probe& probe, const ProbeAddress& address, std::chrono::milliseconds patience);

/** Runs all probes that fit an address, each for at most `patience`. */
std::vector<ProbeOutcome> probe(const ProbeAddress& address, std::chrono::milliseconds patience);

// Devices' descriptions of themselves, by protocol; none where the bytes are not of that protocol.
std::optional<std::string> pingDeviceIn(std::span<const uint8_t> bytes);        ///< Ping360, Ping1D and similar
                                                                                ///< devices.
std::optional<std::string> ping360DiscoveryIn(std::span<const uint8_t> bytes);  ///< The text on UDP 30303.
std::optional<std::string> oculusIn(std::span<const uint8_t> bytes);            ///< Status, or a connection's bytes.
std::optional<std::string> seaNetIn(std::span<const uint8_t> bytes);            ///< Tritech Micron, SeaKing.
std::optional<std::string> sonar3dIn(std::span<const uint8_t> bytes);           ///< HTTP of a Water Linked Sonar 3D-15.

}  // namespace insonify::device
