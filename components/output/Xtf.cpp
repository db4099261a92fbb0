#include "components/output/Xtf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <ctime>
#include <stdexcept>

#include "components/output/Sides.hpp"
#include "types/Angle.hpp"

namespace insonify::output {
namespace {

static_assert(std::endian::native == std::endian::little,
              "numbers are copied in host order, which must be little endian");

constexpr size_t header_size = 1024, channel_info_at = 256, channel_info_size = 128, ping_header_size = 256,
                 channel_header_size = 64, packet_unit = 64;

/** Places in a block of zeros; offsets are those of the format's tables. */
class Block {
public:
    Block(std::vector<char>& bytes, size_t size) : bytes_(bytes), at_(bytes.size()) { bytes.resize(at_ + size); }
    template <class T>
    void put(size_t offset, T value) {
        std::memcpy(bytes_.data() + at_ + offset, &value, sizeof value);
    }
    void putFloat(size_t offset, double value) { put(offset, static_cast<float>(value)); }
    void putText(size_t offset, const std::string& text, size_t room) {
        std::memcpy(bytes_.data() + at_ + offset, text.data(), std::min(text.size(), room));
    }

private:
    std::vector<char>& bytes_;
    size_t at_;
};

size_t sizeOf(XtfSamples samples) { return samples == XtfSamples::Uint16 ? sizeof(uint16_t) : sizeof(float); }

void putChannelInfo(Block& header, size_t channel, const XtfFormat& format, const types::Sonar& ping) {
    const size_t at = channel_info_at + channel * channel_info_size;
    constexpr uint8_t port = 1, starboard = 2;
    constexpr uint16_t slant_range = 1, unipolar = 1;
    header.put(at, channel == 0 ? port : starboard);
    header.put(at + 2, slant_range);
    header.put(at + 4, unipolar);
    header.put(at + 6, static_cast<uint16_t>(sizeOf(format.samples)));
    header.put(at + 8, uint32_t{1024});  // what programs of old expect there
    header.putText(at + 12, channel == 0 ? "Port" : "Starboard", 16);
    header.putFloat(at + 32, format.frequency_khz);
    header.putFloat(at + 36, ping.beam_width.isUnknown() ? 0 : ping.beam_width.deg());
    header.putFloat(at + 44, ping.beam_height.isUnknown() ? 0 : ping.beam_height.deg());
    header.put(at + 74, static_cast<uint8_t>(format.samples == XtfSamples::Uint16 ? 3 : 5));
}

std::tm dateOf(types::Time time) {
    const auto seconds = static_cast<std::time_t>(time.microseconds / 1'000'000);
    std::tm date{};
    gmtime_r(&seconds, &date);
    return date;
}

void putTime(Block& header, types::Time time) {
    const std::tm date = dateOf(time);
    const auto byte = [](int value) { return static_cast<uint8_t>(value); };
    header.put(14, static_cast<uint16_t>(date.tm_year + 1900));
    header.put(16, byte(date.tm_mon + 1));
    header.put(17, byte(date.tm_mday));
    const std::array day_time{byte(date.tm_hour), byte(date.tm_min), byte(date.tm_sec),
                              byte(static_cast<int>(time.microseconds / 10'000 % 100))};
    header.put(18, day_time);   // of the ping
    header.put(148, day_time);  // of its fix
    header.put(236, day_time);  // of the computer
    header.put(22, static_cast<uint16_t>(date.tm_yday + 1));
}

void putPose(Block& header, const types::Pose& sonar) {
    if (!types::isUsable(sonar)) return;
    const glm::dquat& q = sonar.orientation;
    const double yaw = std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
    const double pitch = std::asin(std::clamp(2 * (q.w * q.y - q.z * q.x), -1.0, 1.0));
    const double roll = std::atan2(2 * (q.w * q.x + q.y * q.z), 1 - 2 * (q.x * q.x + q.y * q.y));
    const double heading = std::fmod(360 - types::degrees(yaw), 360), north = sonar.position.x,
                 east = -sonar.position.y;
    for (const size_t at : {128, 160}) {  // of the ship, of the sonar
        header.put(at, north);
        header.put(at + sizeof(double), east);
    }
    header.putFloat(124, heading);
    header.putFloat(192, -sonar.position.z);
    header.putFloat(204, -types::degrees(pitch));
    header.putFloat(208, types::degrees(roll));
    header.putFloat(212, heading);
    if (const double speed = glm::length(sonar.velocity); std::isfinite(speed)) {
        constexpr double knots = 3600.0 / 1852;
        header.putFloat(120, speed * knots);
        header.putFloat(152, speed * knots);
    }
}

uint32_t beamOf(const types::Sonar& ping, int side) {
    if (const auto beam = firstBeamOn(ping, side)) return *beam;
    throw std::invalid_argument("a ping has no beam to " + std::string(side > 0 ? "port" : "starboard") +
                                "; lines of a side-scan have one to either side");
}

uint16_t wholeNumber(float bin) {
    if (bin >= 0 && bin <= 65535 && std::floor(bin) == bin) return static_cast<uint16_t>(bin);
    throw std::invalid_argument(fmt::format(
        "a bin is {:g}; with samples: uint16 it must be a whole number from 0 to 65535: give the receiver output: code "
        "and code: {{bits: 16}}, or take samples: float32",
        bin));
}

void putSamples(const float* bins, uint32_t count, bool far_first, XtfSamples samples, std::vector<char>& bytes) {
    Block block(bytes, count * sizeOf(samples));
    for (uint32_t i = 0; i < count; ++i) {
        const float bin = bins[far_first ? count - 1 - i : i];
        if (samples == XtfSamples::Uint16)
            block.put(i * sizeof(uint16_t), wholeNumber(bin));
        else
            block.put(i * sizeof(float), bin);
    }
}

void putChannel(const XtfFormat& format, const types::Sonar& ping, const XtfPing& more, uint16_t channel,
                std::vector<char>& bytes) {
    const uint32_t beam = beamOf(ping, channel == 0 ? 1 : -1);
    const double range = ping.binStart(ping.bin_count);
    Block header(bytes, channel_header_size);
    header.put(0, channel);
    header.putFloat(4, range);
    header.putFloat(16, 2 * range / static_cast<double>(ping.speed_of_sound));
    header.putFloat(20, more.since_last);
    header.put(26, static_cast<uint16_t>(std::min(format.frequency_khz, 65535.0)));
    header.put(42, ping.bin_count);
    putSamples(ping.bins.data() + size_t{beam} * ping.bin_count, ping.bin_count, channel == 0, format.samples, bytes);
}

}  // namespace

std::vector<char> xtfHeader(const XtfFormat& format, const types::Sonar& ping) {
    std::vector<char> bytes;
    Block header(bytes, header_size);
    constexpr uint8_t file_format = 0x7B, system = 1;
    header.put(0, file_format);
    header.put(1, system);
    header.putText(2, "Insonify", 8);
    header.putText(10, "223", 8);  // programs of old ask for at least this
    header.putText(18, "Insonify", 16);
    header.putText(100, format.name, 63);
    header.put(164, uint16_t{0});  // places are metres
    header.put(166, uint16_t{2});  // channels
    putChannelInfo(header, 0, format, ping);
    putChannelInfo(header, 1, format, ping);
    return bytes;
}

void appendXtfPing(const XtfFormat& format, const types::Sonar& ping, const XtfPing& more, std::vector<char>& bytes) {
    if (!ping.wellShaped()) throw std::invalid_argument("the lists of a ping are not as long as its counts say");
    const size_t lines = 2 * (channel_header_size + ping.bin_count * sizeOf(format.samples));
    const size_t size = (ping_header_size + lines + packet_unit - 1) / packet_unit * packet_unit;
    const size_t begin = bytes.size();
    Block header(bytes, ping_header_size);
    header.put(0, uint16_t{0xFACE});
    header.put(4, uint16_t{2});
    header.put(10, static_cast<uint32_t>(size));
    header.put(28, more.number);
    header.putFloat(32, static_cast<double>(ping.speed_of_sound));
    header.putFloat(72, static_cast<double>(ping.speed_of_sound));
    header.putFloat(196, more.altitude);
    putTime(header, ping.time);
    putPose(header, more.sonar);
    for (const uint16_t channel : {uint16_t{0}, uint16_t{1}}) putChannel(format, ping, more, channel, bytes);
    bytes.resize(begin + size);
}

}  // namespace insonify::output
