#pragma once
// SeaNet, what Tritech's sonars and their drivers say to each other over a serial line or TCP.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/device/Framer.hpp"

namespace insonify::device {

/** Kinds of messages; those that are not named here are passed on as they are. */
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

/** What a head is told to do, from the beginning of the payload as in mtHeadCommand. */
struct SeaNetHeadCommand {
    uint16_t control = 0;
    uint8_t head_type = seanet_imaging_sonar;  ///< Drivers of a Micron DST name 0x11, and want it back in scan lines.
    uint32_t transmit[2] = {0, 0};             ///< Of either channel: frequency * 2^32 / 32 MHz; 0: the head's own.
    uint16_t range_decimetres = 0;
    uint16_t left = 0, right = 0;     ///< Limits of the sector.
    uint8_t ad_span = 0, ad_low = 0;  ///< Of 255 for 80 dB: what 4 bits show.
    uint8_t gain = 0;                 ///< Of 210.
    uint8_t motor_delay = 0;          ///< For 1/16 gradian [10 us].
    uint8_t step = 0;                 ///< [1/16 gradian]
    uint16_t ad_interval = 0;         ///< Of a bin, there and back [640 ns].
    uint16_t bins = 0;

    bool has(uint16_t bit) const { return (control & bit) != 0; }
    SeaNetMessage message() const;
    /** None where it is shorter than what is told here. */
    static std::optional<SeaNetHeadCommand> in(const SeaNetMessage& message);
    /** True for the head command of one byte that turns a scanning head round at once. */
    static bool isReversal(const SeaNetMessage& message);
};

/** One scan line. */
struct SeaNetHeadData {
    uint8_t status = 0;         ///< Bit 1: the motor has failed.
    uint8_t sweep = 0;          ///< 0: scanning; 1: at the left limit; 2: at the right one.
    SeaNetHeadCommand command;  ///< By which it was made.
    uint16_t bearing = seanet_ahead;
    Bytes data;  ///< A byte for each bin, or for two where the command asks for 4 bits: the nearer in the lower ones.

    SeaNetMessage message() const;
    /** None where bytes and what they tell of themselves disagree. */
    static std::optional<SeaNetHeadData> in(const SeaNetMessage& message);
};

/** The state of a head. */
struct SeaNetAlive {
    bool recentring = false, centred = false, motor_on = false, scanning = false, unconfigured = true,
         configured = false;
    uint32_t milliseconds = 0;  ///< Since it was switched on.
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

/** mtBBUserData, of which a driver reads one thing. */
struct SeaNetUserData {
    bool full_duplex = true;  ///< May send while it listens.

    SeaNetMessage message() const;
    static std::optional<SeaNetUserData> in(const SeaNetMessage& message);
};

/** A request that has no payload; mtSendData carries the time of day. */
SeaNetMessage seaNetRequest(SeaNetType type);

/** Finds packets in bytes as they come. What lies between them, and what begins like one and is none (two lengths that
 *  differ, no line feed where it ends), is passed over; so is one that is cut off, once a whole one has come behind it.
 */
class SeaNetReader final : public Framer {
public:
    SeaNetReader() : Framer(CutOff::IsPassedOver) {}

    std::optional<SeaNetMessage> next();

private:
    size_t sizeOf(std::span<const uint8_t> bytes) const override;
};

}  // namespace insonify::device
