#pragma once
// A driver of a Micron, with the bytes of open drivers and their checks.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace insonify::test {

class MicronDriver {
public:
    using Bytes = std::vector<uint8_t>;
    struct Settings {
        double resolution = 0.1, max_distance = 20, speed_of_sound = 1500;  // [m], [m/s]
        double left = std::numbers::pi, right = -std::numbers::pi;          // positive to port [rad]
        double step = 2 * std::numbers::pi / 400;                           // [rad]
        double gain = 0.4;
        bool low_resolution = false, continuous = true;
        uint8_t head_type = 2;
    };
    struct Beam {
        double bearing = 0, sampling_interval = 0;  // [rad], there and back [s]
        Bytes bins;
    };

    /** `write` sends; `read` waits for more and throws if nothing arrives. */
    MicronDriver(std::function<void(const Bytes&)> write, std::function<Bytes()> read)
        : write_(std::move(write)), read_(std::move(read)) {}

    void reboot() {
        send(16);
        bytes_.clear();
        makePacket(4);
    }
    int serialNumber() {
        send(23);
        const Bytes packet = makePacket(1);
        return packet[15] | packet[16] << 8;
    }
    bool isFullDuplex() {
        send(24);
        return makePacket(6)[146] == 0;
    }
    void configure(const Settings& settings) {
        command_ = getCommand(settings);
        send(19, command_);
        for (int tries = 0; tries < 5; ++tries) {
            const uint8_t state = makePacket(4)[20];
            if ((state & 2) || !(state & 64) || (state & 128)) return;
        }
        throw std::runtime_error("the configuration was not accepted");
    }
    /** Opens a head like McGill's ros-tritech-micron, which reads the bits of the state in reverse order: it waits
     *  until a head reports that it is recentring and not centred. Returns false if it would wait for ever. */
    bool openLikeMcGill(Settings settings) {
        settings.head_type = mcgill_head_type;
        send(16);
        uint8_t state = makePacket(4)[20];
        command_ = getCommand(settings);
        send(19, command_);
        constexpr int max_packets = 10;
        for (int i = 0; i < max_packets && !mcgillTakes(state); ++i) state = makePacket(4)[20];
        return mcgillTakes(state) && mcgillTakes(makePacket(4)[20]);  // asked again before the first line
    }
    /** Reverses the head, with the head command of one byte. */
    void reverse() { send(19, {0x0F}); }
    void request() { send(25, Bytes(4)); }
    Beam beam() {
        const Bytes packet = makePacket(2);
        check(packet);
        Beam beam;
        beam.sampling_interval = 640e-9 * number(packet, 33);
        beam.bearing = std::numbers::pi - number(packet, 40) / 6399.0 * 2 * std::numbers::pi;
        for (int i = 0; i < number(packet, 42); ++i) {
            const uint8_t byte = packet[static_cast<size_t>(44 + i)];
            if (packet[18] & 1) {
                beam.bins.push_back(byte);
            } else {
                beam.bins.push_back(static_cast<uint8_t>((byte & 15) * 17));
                beam.bins.push_back(static_cast<uint8_t>((byte >> 4) * 17));
            }
        }
        return beam;
    }
    const Bytes& command() const { return command_; }

private:
    static constexpr uint8_t mcgill_head_type = 0x11;
    static bool mcgillTakes(uint8_t state) { return (state & 1) != 0 && (state & 2) == 0; }
    static int number(const Bytes& packet, size_t at) { return packet[at] | packet[at + 1] << 8; }
    static void put(Bytes& payload, size_t at, int value) {
        payload[at] = static_cast<uint8_t>(value);
        payload[at + 1] = static_cast<uint8_t>(value >> 8);
    }

    static Bytes getCommand(const Settings& settings) {
        const auto limit = [](double angle) {
            return static_cast<int>((angle + std::numbers::pi) / (2 * std::numbers::pi) * 6399);
        };
        Bytes payload(68);  // with the parameters of both channels
        payload[0] = 0x1D;
        put(payload, 1, (settings.low_resolution ? 0 : 1) | (settings.continuous ? 2 : 0) | 128 | 256 | 512 | 8192);
        payload[3] = settings.head_type;
        put(payload, 22, 40);
        put(payload, 24, limit(settings.right));  // the sonar counts clockwise
        put(payload, 26, limit(settings.left));
        payload[28] = 81;
        payload[29] = 8;
        payload[30] = payload[31] = static_cast<uint8_t>(settings.gain * 210);
        payload[36] = 25;
        payload[37] = static_cast<uint8_t>(settings.step / (2 * std::numbers::pi) * 6399);
        put(payload, 38, static_cast<int>(settings.resolution / settings.speed_of_sound * 2e9 / 640));
        put(payload, 40, static_cast<int>(settings.max_distance / settings.resolution));
        return payload;
    }

    void send(uint8_t type, const Bytes& payload = {}) {
        const size_t length = payload.size() + 8;
        char digits[9];
        std::snprintf(digits, sizeof digits, "%04zX", length);
        Bytes packet(5, '@');
        std::copy(digits, digits + 4, packet.begin() + 1);
        for (const int byte : {static_cast<int>(length & 255), static_cast<int>(length >> 8), 255, 2,
                               static_cast<int>(payload.size() + 3) & 255, static_cast<int>(type), 0x80, 2})
            packet.push_back(static_cast<uint8_t>(byte));
        packet.insert(packet.end(), payload.begin(), payload.end());
        packet.push_back(0x0A);
        write_(packet);
    }

    /** Returns the next packet of a type, and skips others. */
    Bytes makePacket(uint8_t type) {
        for (int others = 0; others < 100; ++others) {
            while (bytes_.size() < 14 || bytes_.size() < size()) {
                const Bytes more = read_();
                bytes_.insert(bytes_.end(), more.begin(), more.end());
            }
            const Bytes packet(bytes_.begin(), bytes_.begin() + static_cast<long>(size()));
            bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<long>(size()));
            checkSize(packet);
            if (packet[10] == type) return packet;
        }
        throw std::runtime_error("nothing but other packets");
    }
    /** Returns the size of the packet at the beginning, which must be valid: our device is never out of step. */
    size_t size() const {
        unsigned written = 0;
        if (bytes_[0] != '@' || std::sscanf(reinterpret_cast<const char*>(&bytes_[1]), "%4X", &written) != 1 ||
            written != static_cast<unsigned>(number(bytes_, 5)))
            throw std::runtime_error("corrupted packet");
        return written + 6;
    }
    static void checkSize(const Bytes& packet) {
        const size_t size = packet.size();
        const bool good = packet[10] == 1   ? size == 25
                          : packet[10] == 4 ? size == 22
                          : packet[10] == 6 ? size == 175 || size == 264
                          : packet[10] == 2 ? size > 45 && static_cast<int>(size) == number(packet, 13) + 14 &&
                                                  static_cast<int>(size) == number(packet, 42) + 45
                                            : true;
        if (packet.back() != 0x0A || !good)
            throw std::runtime_error("wrong packet size for type " + std::to_string(packet[10]));
    }
    /** Checks the fields that must agree with the command. */
    void check(const Bytes& packet) const {
        const auto differ = [&](size_t in_packet, size_t in_command) {
            return number(packet, in_packet) != number(command_, in_command);
        };
        if (packet[7] != 2 || packet[15] != command_[3]) throw std::runtime_error("wrong device type");
        if (packet[16] & 2) throw std::runtime_error("motor error");
        if (differ(35, 24) || differ(37, 26) || packet[39] != command_[37] || packet[29] != command_[28] ||
            packet[30] != command_[29] || (packet[18] & (1 | 2 | 8)) != (command_[1] & (1 | 2 | 8)))
            throw std::runtime_error("configuration of the beam differs from the desired one");
    }

    std::function<void(const Bytes&)> write_;
    std::function<Bytes()> read_;
    Bytes bytes_, command_;
};

}  // namespace insonify::test
