#include "components/recordings/Xtf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <ctime>
#include <stdexcept>

#include "components/recordings/XtfLayout.hpp"
#include "types/Check.hpp"
#include "types/geometry/Angle.hpp"
#include "types/geometry/BeamArc.hpp"
#include "types/geometry/WorldFrame.hpp"

namespace insonify::recordings {
namespace {

/** A block of zeros with fields; offsets are those of the format's tables. */
class Block {
public:
    Block(std::vector<char>& bytes, size_t size) : bytes_(bytes), at_(bytes.size()) { bytes.resize(at_ + size); }
    template <class T>
    void put(size_t offset, T value) {
        INSONIFY_CHECK(at_ + offset + sizeof value <= bytes_.size(), at_, offset, bytes_.size());
        std::memcpy(bytes_.data() + at_ + offset, &value, sizeof value);
    }
    void putFloat(size_t offset, double value) { put(offset, static_cast<float>(value)); }
    void putText(size_t offset, const std::string& text, size_t room) {
        INSONIFY_CHECK(at_ + offset + room <= bytes_.size(), at_, offset, room, bytes_.size());
        std::memcpy(bytes_.data() + at_ + offset, text.data(), std::min(text.size(), room));
    }

private:
    std::vector<char>& bytes_;
    size_t at_;
};

size_t getSize(XtfSamples samples) { return samples == XtfSamples::Uint16 ? sizeof(uint16_t) : sizeof(float); }

void putChannelInfo(Block& header, size_t channel, const XtfFormat& format, const types::Sonar& ping) {
    namespace info = xtf::channel_info;
    const size_t at = xtf::file_header::channel_infos + channel * info::size;
    constexpr uint16_t slant_range = 1, unipolar = 1;
    header.put(at + info::type, channel == 0 ? info::port : info::starboard);
    header.put(at + info::correction, slant_range);
    header.put(at + info::unipolar, unipolar);
    header.put(at + info::sample_bytes, static_cast<uint16_t>(getSize(format.samples)));
    header.put(at + info::sample_count, uint32_t{1024});  // expected by old programs
    header.putText(at + info::name, channel == 0 ? "Port" : "Starboard", 16);
    header.putFloat(at + info::frequency, format.frequency_khz);
    header.putFloat(at + info::beam_width, ping.beam_width.isUnknown() ? 0 : ping.beam_width.deg());
    header.putFloat(at + info::beam_height, ping.beam_height.isUnknown() ? 0 : ping.beam_height.deg());
    header.put(at + info::sample_format, format.samples == XtfSamples::Uint16 ? info::int16 : info::float32);
}

std::tm toDate(types::Time time) {
    const auto seconds = static_cast<std::time_t>(time.microseconds / 1'000'000);
    std::tm date{};
    gmtime_r(&seconds, &date);
    return date;
}

void putTime(Block& header, types::Time time) {
    const std::tm date = toDate(time);
    const auto byte = [](int value) { return static_cast<uint8_t>(value); };
    header.put(xtf::ping_header::year, static_cast<uint16_t>(date.tm_year + 1900));
    header.put(xtf::ping_header::month, byte(date.tm_mon + 1));
    header.put(xtf::ping_header::day, byte(date.tm_mday));
    const std::array day_time{byte(date.tm_hour), byte(date.tm_min), byte(date.tm_sec),
                              byte(static_cast<int>(time.microseconds / 10'000 % 100))};
    for (const size_t at : {xtf::ping_header::day_time, xtf::ping_header::fix_time, xtf::ping_header::computer_time})
        header.put(at, day_time);
    header.put(xtf::ping_header::day_of_year, static_cast<uint16_t>(date.tm_yday + 1));
}

void putPose(Block& header, const types::Pose& sonar) {
    if (!types::isUsable(sonar)) return;
    const auto [yaw, pitch, roll] = types::toTurns(sonar.orientation);
    const double heading = std::fmod(360 - types::degrees(yaw), 360), north = sonar.position.x,
                 east = -sonar.position.y;
    for (const size_t at : {xtf::ping_header::ship, xtf::ping_header::sonar}) {
        header.put(at, north);
        header.put(at + sizeof(double), east);
    }
    header.putFloat(xtf::ping_header::ship_heading, heading);
    header.putFloat(xtf::ping_header::depth, -sonar.position.z);
    header.putFloat(xtf::ping_header::pitch, -types::degrees(pitch));
    header.putFloat(xtf::ping_header::roll, types::degrees(roll));
    header.putFloat(xtf::ping_header::heading, heading);
    if (const double speed = glm::length(sonar.velocity); std::isfinite(speed)) {
        constexpr double knots = 3600.0 / 1852;
        header.putFloat(xtf::ping_header::ship_speed, speed * knots);
        header.putFloat(xtf::ping_header::sonar_speed, speed * knots);
    }
}

uint32_t getBeam(const types::Sonar& ping, int side) {
    if (const auto beam = types::firstBeamOn(ping, side)) return *beam;
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
    Block block(bytes, count * getSize(samples));
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
    const uint32_t beam = getBeam(ping, channel == 0 ? 1 : -1);
    const double range = ping.binStart(ping.bin_count);
    namespace fields = xtf::channel_header;
    Block header(bytes, fields::size);
    header.put(fields::channel, channel);
    header.putFloat(fields::slant_range, range);
    header.putFloat(fields::duration, 2 * range / static_cast<double>(ping.speed_of_sound));
    header.putFloat(fields::since_last, std::max(0.0, more.since_last));
    header.put(fields::frequency, static_cast<uint16_t>(std::min(format.frequency_khz, 65535.0)));
    header.put(fields::sample_count, ping.bin_count);
    putSamples(ping.bins.data() + size_t{beam} * ping.bin_count, ping.bin_count, channel == 0, format.samples, bytes);
}

}  // namespace

std::vector<char> xtfHeader(const XtfFormat& format, const types::Sonar& ping) {
    std::vector<char> bytes;
    namespace fields = xtf::file_header;
    Block header(bytes, fields::size);
    header.put(fields::format, fields::mark);
    header.put(fields::system, uint8_t{1});
    header.putText(fields::program, "Insonify", 8);
    header.putText(fields::program_version, "223", 8);  // min version that old programs require
    header.putText(fields::sonar, "Insonify", 16);
    header.putText(fields::name, format.name, 63);
    header.put(fields::nav_units, fields::metres);
    header.put(fields::channel_count, uint16_t{2});
    putChannelInfo(header, 0, format, ping);
    putChannelInfo(header, 1, format, ping);
    return bytes;
}

void appendXtfPing(const XtfFormat& format, const types::Sonar& ping, const XtfPing& more, std::vector<char>& bytes) {
    if (!ping.wellShaped()) throw std::invalid_argument("the lists of a ping do not match its counts");
    const size_t lines = 2 * (xtf::channel_header::size + ping.bin_count * getSize(format.samples));
    const size_t unit = xtf::packet::unit, size = (xtf::ping_header::size + lines + unit - 1) / unit * unit;
    const size_t begin = bytes.size();
    namespace fields = xtf::ping_header;
    Block header(bytes, fields::size);
    header.put(xtf::packet::mark, xtf::packet::magic);
    header.put(xtf::packet::channel_count, uint16_t{2});
    header.put(xtf::packet::bytes, static_cast<uint32_t>(size));
    header.put(fields::number, more.number);
    header.putFloat(fields::sound_speed, static_cast<double>(ping.speed_of_sound));
    header.putFloat(fields::computed_sound_speed, static_cast<double>(ping.speed_of_sound));
    header.putFloat(fields::altitude, more.altitude);
    putTime(header, ping.time);
    putPose(header, more.sonar);
    for (const uint16_t channel : {uint16_t{0}, uint16_t{1}}) putChannel(format, ping, more, channel, bytes);
    bytes.resize(begin + size);
}

}  // namespace insonify::recordings
