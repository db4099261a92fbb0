#pragma once
// SeaNet, the protocol of Tritech's sonars and their drivers over a serial line or TCP.
#include <optional>
#include <span>

#include "components/device/wire/Framer.hpp"

namespace insonify::device {

/** Kinds of messages; other kinds are passed on unchanged. */
enum class SeaNetType : uint8_t {
    VersionData = 1,
    HeadData = 2,
    Alive = 4,
    UserData = 6,
    Reboot = 16,
    HeadCommand = 19,
    SendVersion = 23,
    SendUserData = 24,
    SendData = 25,
    StopAlive = 66,
};

constexpr uint8_t seanet_computer = 255, seanet_imaging_sonar = 2;  ///< Nodes.

/** A packet without its frame. */
struct SeaNetMessage {
    SeaNetType type = SeaNetType::Alive;
    uint8_t from = seanet_imaging_sonar;
    uint8_t to = seanet_computer;
    Bytes payload;

    /** '@', length in hexadecimal and in binary, nodes, type, payload, line feed. */
    Bytes packet() const;
};

/** Angles on the wire: 1/16 gradian, clockwise, 3200 ahead. */
constexpr int seanet_turn = 6400, seanet_ahead = 3200;

/** Bits of `control` in commands and scan lines. */
struct SeaNetControl {
    static constexpr uint16_t eight_bits = 1, continuous = 2, clockwise = 4, inverted = 8, motor_off = 16, silent = 32,
                              second_channel = 128;
};

/** A head command, from the beginning of the payload as in mtHeadCommand. */
struct SeaNetHeadCommand {
    uint16_t control = 0;
    uint8_t head_type = seanet_imaging_sonar;  ///< Drivers of a Micron DST send 0x11, and expect it in scan lines.
    uint32_t transmit[2] = {0, 0};             ///< One per channel: frequency * 2^32 / 32 MHz; 0: the head's own.
    uint16_t range_decimetres = 0;
    uint16_t left = 0, right = 0;     ///< Limits of the sector.
    uint8_t ad_span = 0, ad_low = 0;  ///< In 255ths of 80 dB: the interval that 4 bits show.
    uint8_t gain = 0;                 ///< In 210ths.
    uint8_t motor_delay = 0;          ///< Per 1/16 gradian [10 us].
    uint8_t step = 0;                 ///< [1/16 gradian]
    uint16_t ad_interval = 0;         ///< Two-way travel time of a bin [640 ns].
    uint16_t bins = 0;

    bool has(uint16_t bit) const { return (control & bit) != 0; }
    SeaNetMessage message() const;
    /** None if the message is shorter than these fields. */
    static std::optional<SeaNetHeadCommand> in(const SeaNetMessage& message);
    /** Whether this is the head command of one byte that reverses a scanning head at once. */
    static bool isReversal(const SeaNetMessage& message);
};

/** One scan line. */
struct SeaNetHeadData {
    uint8_t status = 0;         ///< Bit 1: the motor has failed.
    uint8_t sweep = 0;          ///< 0: scanning; 1: at the left limit; 2: at the right one.
    SeaNetHeadCommand command;  ///< The command of the line.
    uint16_t bearing = seanet_ahead;
    Bytes data;  ///< One byte per bin, or per two bins at 4 bits: the nearer bin in the lower bits.

    SeaNetMessage message() const;
    /** None if the bytes contradict their own counts. */
    static std::optional<SeaNetHeadData> in(const SeaNetMessage& message);
};

/** The state of a head. */
struct SeaNetAlive {
    bool recentring = false, centred = false, motor_on = false, scanning = false, unconfigured = true,
         configured = false;
    uint32_t milliseconds = 0;  ///< Since power-on.
    uint16_t bearing = seanet_ahead;

    SeaNetMessage message() const;
    static std::optional<SeaNetAlive> in(const SeaNetMessage& message);
};

struct SeaNetVersion {
    uint8_t software = 0, info = 0;
    uint16_t serial = 0;
    uint32_t program_length = 0;
    uint16_t program_sum = 0;

    SeaNetMessage message() const;
    static std::optional<SeaNetVersion> in(const SeaNetMessage& message);
};

/** mtBBUserData, of which drivers read one field. */
struct SeaNetUserData {
    bool full_duplex = true;  ///< May send while it receives.

    SeaNetMessage message() const;
    static std::optional<SeaNetUserData> in(const SeaNetMessage& message);
};

/** A request without payload; mtSendData has the time of day. */
SeaNetMessage seaNetRequest(SeaNetType type);

/** Finds packets in a stream of bytes. Bytes between packets and false beginnings (two lengths that differ, no line
 *  feed at the end) are skipped. An incomplete packet is skipped once a complete one has arrived behind it. */
class SeaNetReader final : public Framer {
public:
    SeaNetReader() : Framer(CutOff::IsPassedOver) {}

    std::optional<SeaNetMessage> next();

private:
    size_t getSize(std::span<const uint8_t> bytes) const override;
};

}  // namespace insonify::device
