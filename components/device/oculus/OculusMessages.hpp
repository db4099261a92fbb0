#pragma once
// Messages to and from a Blueprint Subsea Oculus. Each message is a struct with all its fields, read and written by one
// list of the fields. Packed, little endian.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/device/wire/Framer.hpp"

namespace insonify::device {

inline constexpr uint16_t oculus_mark = 0x4F53;
/** The clock in pings of version 1, from a recording at ten pings per second. */
inline constexpr double oculus_ticks_per_second = 625e6;

/** The kind of a message, in its header. */
enum class OculusId : uint16_t {
    Status = 0x01,  ///< Over UDP, where listeners check only the size.
    Fire = 0x15,
    FullResult = 0x22,
    PingResult = 0x23,
    UserConfig = 0x55,
    Log = 0x80,
    Dummy = 0xFF,
};

struct OculusHeader {
    static constexpr size_t size = 16;
    uint16_t source = 0, destination = 0;
    uint16_t id = 0, version = 0;
    uint32_t payload_size = 0;  ///< Without the header [B].
    uint16_t part = 0;

    bool is(OculusId other) const { return id == static_cast<uint16_t>(other); }
};

/** The settings of all following pings. Version 2 if the header says so; every other version is 1. */
struct OculusFire {
    static constexpr size_t size_v1 = 53, size_v2 = 89;
    // Bits of `flags`, and of `extended_flags`.
    static constexpr uint8_t range_in_metres = 0x01, wide_16 = 0x02, row_gains = 0x04, simple_result = 0x08,
                             gain_assist = 0x10, beams_512 = 0x40;
    static constexpr uint32_t wide_32 = 0x200;
    static constexpr uint8_t standby = 5;  ///< As `rate`.

    OculusHeader header{.id = static_cast<uint16_t>(OculusId::Fire)};
    uint8_t mode = 1;              ///< 1: low frequency, 2: high.
    uint8_t rate = 0;              ///< 0: 10 Hz, 1: 15, 2: 40, 3: 5, 4: 2, 5: standby.
    uint8_t network_speed = 0xFF;  ///< [Mbit/s]; 0 and 255: unlimited.
    uint8_t gamma = 0xFF;          ///< Exponent of the codes, in 255ths; 0 also means 1.0.
    uint8_t flags = range_in_metres | simple_result;
    double range = 10;          ///< [m] or, without range_in_metres, [%] of the max range.
    double gain_percent = 50;   ///< [%]
    double speed_of_sound = 0;  ///< 0: the device's own [m/s].
    double salinity = 35;       ///< [psu]
    uint32_t extended_flags = 0;
    std::array<uint32_t, 8> reserved{};

    bool isVersion2() const { return header.version == 2; }
    size_t size() const { return isVersion2() ? size_v2 : size_v1; }
    bool isStandby() const { return rate == standby; }
    bool sendsRowGains() const { return (flags & row_gains) != 0; }
    /** Returns the requested bytes per code: 1, 2 or 4. */
    size_t codeBytes() const;
    /** Returns the requested max rate of pings [Hz]; 10 for an unknown number, 0 in standby. */
    double rateHz() const;
    /** Exponent of the amplitudes [1]. */
    double gammaExponent() const { return gamma == 0 ? 1 : gamma / 255.0; }
};

/** One ping, a "simple ping result". `fire` has the header of this message and the settings of the ping. */
struct OculusResult {
    static constexpr size_t size_v1 = 122, size_v2 = 202;  ///< Up to the bearings [B].

    OculusFire fire{.header = {.id = static_cast<uint16_t>(OculusId::PingResult)}};
    uint32_t number = 0, status = 0;
    double frequency_hz = 0;
    double temperature_celsius = 0;
    double pressure_bar = 0;
    double heading_deg = 0, pitch_deg = 0, roll_deg = 0;  ///< Version 2.
    double speed_of_sound = 0;                            ///< Used by the device [m/s].
    uint32_t start_ticks = 0;                             ///< Version 1: of the device's clock, which wraps.
    double start_s = 0;                                   ///< Version 2: since the device was switched on [s].
    uint8_t code_size = 0;                                ///< Bytes per code minus one.
    double range_resolution = 0;                          ///< Slant range of a bin [m].
    uint16_t bin_count = 0, beam_count = 0;
    std::array<uint32_t, 4> spare{};  ///< Version 2.
    uint32_t image_offset = 0;        ///< From the beginning of the message [B].
    uint32_t image_size = 0;          ///< [B]
    uint32_t message_size = 0;        ///< [B]
    std::vector<int16_t> bearings;    ///< [0.01 deg], positive to starboard.
    Bytes before_image;               ///< Bytes between bearings and image.
    Bytes image;  ///< A row for each bin, nearest first: its gain, if sent, and a code for each beam.
    Bytes after_image;

    size_t codeBytes() const { return size_t{code_size} + 1; }
    size_t gainBytes() const { return fire.sendsRowGains() ? 4 : 0; }
    size_t rowBytes() const { return gainBytes() + beam_count * codeBytes(); }
    size_t fixedSize() const { return fire.isVersion2() ? size_v2 : size_v1; }
    /** Sets every size and offset from the bearings and the image, without bytes between them. */
    void settle();
};

/** Sent each second to UDP port 52102. */
struct OculusStatus {
    static constexpr size_t size = 142;
    static constexpr uint32_t running = 3;  ///< Bits 0 to 2 of `status`: the main program runs.

    OculusHeader header{.id = static_cast<uint16_t>(OculusId::Status), .payload_size = size - OculusHeader::size};
    uint32_t device_id = 0;
    uint16_t device_type = 1;  ///< 1: an imaging sonar.
    uint16_t part = 0;
    uint32_t status = running;
    std::array<uint32_t, 6> versions{};
    std::array<uint8_t, 4> address{}, mask{}, connected{};  ///< IPv4; of the device, of its network, of its client.
    std::array<uint8_t, 6> mac{};
    std::array<double, 8> temperatures{};  ///< [degrees Celsius]
    double pressure_bar = 0;
};

/** The network settings of a device. */
struct OculusUserConfig {
    static constexpr size_t size = 28;
    OculusHeader header{.id = static_cast<uint16_t>(OculusId::UserConfig), .payload_size = size - OculusHeader::size};
    std::array<uint8_t, 4> address{}, mask{};
    uint32_t dhcp = 0;
};

/** None unless the bytes begin with a header. */
std::optional<OculusHeader> oculusHeader(std::span<const uint8_t> bytes);

/** Reads a fire message at the beginning of the bytes. Payload size 0 means the size of its version; bytes beyond the
 *  size of its version are ignored. A version 2 message only as long as version 1 has no extended flags. None: too
 *  short, or another message. */
std::optional<OculusFire> oculusFire(std::span<const uint8_t> message);
/** With the payload size of its version. */
Bytes toBytes(OculusFire fire);

/** Reads a ping with every byte. None if the ping contradicts itself: missing bytes, an image whose size does not match
 *  bins and beams, impossible numbers.
 *  @param diagnostic receives the reason, after "the ping", unless null */
std::optional<OculusResult> oculusResult(std::span<const uint8_t> message, std::string* diagnostic = nullptr);
/** Writes what oculusResult has read, byte for byte. */
Bytes toBytes(const OculusResult& result);

/** None unless these are 142 bytes of an Oculus. */
std::optional<OculusStatus> oculusStatus(std::span<const uint8_t> datagram);
Bytes toBytes(const OculusStatus& status);

std::optional<OculusUserConfig> oculusUserConfig(std::span<const uint8_t> message);
Bytes toBytes(const OculusUserConfig& config);

/** A header alone, sent in standby instead of pings. */
Bytes oculusDummy(uint16_t source, uint16_t part);
/** A line of text for the device's log. */
Bytes oculusLog(uint16_t source, uint16_t part, const std::string& text);

/** Splits a stream of bytes into messages. After bytes that are not a message, a message of an unknown kind or one of
 *  an impossible size, it continues at the next header. A damaged line thus costs only the damaged messages. */
class OculusFramer final : public Framer {
public:
    /** @param maximum max payload of a message; a header with a larger payload is not accepted [B] */
    explicit OculusFramer(size_t maximum = size_t{1} << 28) : Framer(CutOff::Waits), maximum_(maximum) {}

    /** Returns the next complete message; empty: there is none yet. */
    Bytes next();
    /** Skips the header of an incomplete message at the end of a stream, so that next() continues behind it. False:
     *  there is none. */
    bool giveUp();

private:
    size_t getSize(std::span<const uint8_t> bytes) const override;

    size_t maximum_;
};

}  // namespace insonify::device
