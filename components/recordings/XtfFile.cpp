#include "components/recordings/XtfFile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "components/recordings/XtfLayout.hpp"

namespace insonify::recordings {
namespace {

double floatAt(std::span<const char> bytes, size_t at) { return static_cast<double>(field<float>(bytes, at)); }

/** Returns the bytes of a sample; 0 for an unknown format. */
size_t sampleBytes(uint8_t format, uint16_t legacy_bytes) {
    switch (format) {
        case xtf::channel_info::int8: return 1;
        case xtf::channel_info::int16: return 2;
        case xtf::channel_info::int32:
        case xtf::channel_info::float32: return 4;
        case xtf::channel_info::legacy:
            return legacy_bytes == 1 || legacy_bytes == 2 || legacy_bytes == 4 ? legacy_bytes : 0;
        default: return 0;
    }
}

bool isSide(uint8_t type) { return type == xtf::channel_info::port || type == xtf::channel_info::starboard; }

/** Returns a stated beam width; 0 is unknown. */
types::Angle angleAt(std::span<const char> bytes, size_t at) {
    const double deg = floatAt(bytes, at);
    return deg > 0 && deg <= 360 ? types::Angle{types::radians(deg)} : types::Angle{};
}

float sampleAt(std::span<const char> samples, size_t index, size_t bytes, bool is_float) {
    const size_t at = index * bytes;
    if (is_float) return field<float>(samples, at);
    switch (bytes) {
        case 1: return field<uint8_t>(samples, at);
        case 2: return field<uint16_t>(samples, at);
        default: return static_cast<float>(field<uint32_t>(samples, at));
    }
}

}  // namespace

XtfFile::XtfFile(const std::filesystem::path& path) : RecordingReader(path) { readChannels(); }

void XtfFile::readChannels() {
    namespace header = xtf::file_header;
    namespace info = xtf::channel_info;
    std::vector<char> bytes = take(0, header::size);
    if (bytes.size() < header::size)
        fail(bytes.size(), fmt::format("ends here; an XTF file has a header of {} bytes", header::size));
    in_degrees_ = field<uint16_t>(bytes, header::nav_units) == header::degrees;
    const size_t count =
        size_t{field<uint16_t>(bytes, header::channel_count)} + field<uint16_t>(bytes, header::bathymetry_count);
    const size_t needed = header::channel_infos + count * info::size;
    next_ = (needed + header::size - 1) / header::size * header::size;
    bytes = take(0, next_);
    if (bytes.size() < next_)
        fail(header::channel_count,
             fmt::format("has {} channels, whose header is {} bytes; the file has {}", count, next_, size_));
    for (size_t i = 0; i < count; ++i) {
        const size_t at = header::channel_infos + i * info::size;
        const auto of = std::span<const char>(bytes).subspan(at, info::size);
        Channel channel{field<uint8_t>(of, info::type),
                        field<uint8_t>(of, info::sample_format),
                        0,
                        field<uint32_t>(of, info::sample_count),
                        angleAt(of, info::beam_width),
                        angleAt(of, info::beam_height),
                        floatAt(of, info::frequency)};
        const auto legacy = field<uint16_t>(of, info::sample_bytes);
        channel.sample_bytes = sampleBytes(channel.format, legacy);
        if (channel.sample_bytes == 0 && isSide(channel.type))
            fail(at + info::sample_format,
                 fmt::format("the samples of channel {} have format {} of {} bytes; it may be 0 (1, 2 or 4 bytes), "
                             "2, 3, 5 or 8",
                             i, channel.format, legacy));
        if (channel.sample_bytes == 0) channel.sample_bytes = legacy;
        channels_.push_back(channel);
    }
}

bool XtfFile::nextPacket() {
    packet_ = readPacket(xtf::packet::size, [&](std::span<const char> head) -> uint64_t {
        if (const auto mark = field<uint16_t>(head, xtf::packet::mark); mark != xtf::packet::magic)
            fail(at_, fmt::format("is 0x{:04X}; a packet begins with 0x{:04X}", mark, xtf::packet::magic));
        const auto bytes = field<uint32_t>(head, xtf::packet::bytes);
        if (bytes < xtf::packet::size)
            fail(at_ + xtf::packet::bytes,
                 fmt::format("the packet has {} bytes; it must have at least {}", bytes, xtf::packet::size));
        return bytes;
    });
    return !packet_.empty();
}

std::optional<RecordedPing> XtfFile::read() {
    while (nextPacket()) {
        if (const auto type = field<uint8_t>(packet_, xtf::packet::type); type != xtf::packet::sonar)
            ++other_packets_[type];
        else if (auto read = line())
            return read;
        else
            ++without_side_;
    }
    return std::nullopt;
}

XtfFile::Side XtfFile::side(size_t offset) const {
    namespace fields = xtf::channel_header;
    const uint64_t at = at_ + offset;
    const size_t left = packet_.size() - offset;
    if (left < fields::size)
        fail(at, fmt::format("{} bytes are left of the packet; the header of a channel has {}", left, fields::size));
    Side side;
    side.at = at;
    side.header = std::span<const char>(packet_).subspan(offset, fields::size);
    const auto number = field<uint16_t>(side.header, fields::channel);
    if (number >= channels_.size())
        fail(at + fields::channel, fmt::format("the channel is {}; the header of the file has {} channels, from 0",
                                               number, channels_.size()));
    side.channel = &channels_[number];
    side.count = field<uint32_t>(side.header, fields::sample_count);
    if (side.count == 0) side.count = side.channel->sample_count;
    const uint64_t bytes = uint64_t{side.count} * side.channel->sample_bytes;
    if (bytes > left - fields::size)
        fail(at + fields::sample_count,
             fmt::format("the channel has {} samples of {} bytes; {} bytes are left of the packet", side.count,
                         side.channel->sample_bytes, left - fields::size));
    side.samples = std::span<const char>(packet_).subspan(offset + fields::size, static_cast<size_t>(bytes));
    return side;
}

XtfFile::Sides XtfFile::sides() {
    Sides found;
    size_t offset = xtf::ping_header::size;
    for (int left = field<uint16_t>(packet_, xtf::packet::channel_count); left > 0; --left) {
        const Side read = side(offset);
        offset += read.header.size() + read.samples.size();
        auto& place = read.channel->type == xtf::channel_info::port ? found.port : found.starboard;
        if (isSide(read.channel->type) && !place && read.count > 0)
            place = read;
        else
            ++other_channels_[static_cast<size_t>(read.channel - channels_.data())];
    }
    return found;
}

double XtfFile::rangeOf(const Side& side, double speed_of_sound) const {
    namespace fields = xtf::channel_header;
    double range = floatAt(side.header, fields::slant_range);
    if (range == 0) range = floatAt(side.header, fields::duration) * speed_of_sound / 2;
    if (!(range > 0 && range <= 1e5))
        fail(side.at + fields::slant_range,
             fmt::format("the slant range is {:g} m; it must be above 0 and at most 100000", range));
    return range;
}

double XtfFile::speedOfSound() const {
    namespace fields = xtf::ping_header;
    double speed = floatAt(packet_, fields::sound_speed);
    if (speed == 0) speed = floatAt(packet_, fields::computed_sound_speed);
    if (speed == 0) return 1500;
    if (speed >= 500 && speed < 1000) return 2 * speed;  // many programs write the range per second of two-way time
    if (!(speed >= 1000 && speed <= 2000))
        fail(
            at_ + fields::sound_speed,
            fmt::format("the speed of sound is {:g} m/s; it may be 1000 to 2000, half of it, or 0 for unknown", speed));
    return speed;
}

types::Time XtfFile::time() const {
    namespace fields = xtf::ping_header;
    const auto byte = [&](size_t at) { return int{field<uint8_t>(packet_, at)}; };
    std::tm date{};
    date.tm_year = field<uint16_t>(packet_, fields::year) - 1900;
    date.tm_mon = byte(fields::month) - 1;
    date.tm_mday = byte(fields::day);
    date.tm_hour = byte(fields::day_time);
    date.tm_min = byte(fields::day_time + 1);
    date.tm_sec = byte(fields::day_time + 2);
    const int hundredths = byte(fields::day_time + 3);
    const std::tm stated = date;
    const int64_t seconds = timegm(&date);  // normalises an invalid date
    const bool is_date = date.tm_mday == stated.tm_mday && date.tm_hour == stated.tm_hour &&
                         date.tm_min == stated.tm_min && date.tm_mon == stated.tm_mon;
    if (!is_date || stated.tm_sec > 60 || hundredths > 99 || seconds <= 0 || stated.tm_year > 300)
        fail(at_ + fields::year,
             fmt::format("the time is {}-{:02}-{:02} {:02}:{:02}:{:02}.{:02}; it must be a date from 1970 to 2200",
                         stated.tm_year + 1900, stated.tm_mon + 1, stated.tm_mday, stated.tm_hour, stated.tm_min,
                         stated.tm_sec, hundredths));
    return {seconds * 1'000'000 + int64_t{hundredths} * 10'000};
}

std::optional<RecordingReader::Stated> XtfFile::stated() const {
    namespace fields = xtf::ping_header;
    const auto pairAt = [&](size_t at) {
        return glm::dvec2(field<double>(packet_, at), field<double>(packet_, at + sizeof(double)));
    };
    const bool has_own = pairAt(fields::sonar) != glm::dvec2(0);
    const glm::dvec2 place = pairAt(has_own ? fields::sonar : fields::ship);
    double heading = floatAt(packet_, fields::heading);
    if (heading == 0) heading = floatAt(packet_, fields::ship_heading);
    const double depth = floatAt(packet_, fields::depth);
    if (place == glm::dvec2(0) && heading == 0 && depth == 0) return std::nullopt;
    return Stated{
        in_degrees_, place.x, place.y, depth, heading, floatAt(packet_, fields::pitch), floatAt(packet_, fields::roll)};
}

void XtfFile::append(const Side& side, bool is_port, types::Sonar& ping) {
    const int weight = field<int16_t>(side.header, xtf::channel_header::weight);
    const bool is_float = side.channel->format == xtf::channel_info::float32;
    const auto sample = [&](uint32_t i) {
        const uint32_t at = is_port ? side.count - 1 - i : i;  // port runs from the far end to the sonar
        const float value = sampleAt(side.samples, at, side.channel->sample_bytes, is_float);
        return weight == 0 ? value : std::ldexp(value, -weight);
    };
    appendSide(is_port, 0, side.count, sample, ping);
}

void XtfFile::setBins(const Sides& sides, double speed_of_sound, RecordedPing& to) {
    const Side& any = sides.starboard ? *sides.starboard : *sides.port;
    setResolution(any.resolution(), speed_of_sound, to);
    types::Sonar& ping = to.ping;
    ping.beam_width = any.channel->beam_width;
    ping.beam_height = any.channel->beam_height;
    ping.bin_count = std::max(sides.port ? sides.port->count : 0, sides.starboard ? sides.starboard->count : 0);
    if (sides.starboard) append(*sides.starboard, false, ping);
    if (sides.port) append(*sides.port, true, ping);
}

std::optional<RecordedPing> XtfFile::line() {
    namespace fields = xtf::ping_header;
    if (packet_.size() < fields::size)
        fail(at_ + xtf::packet::bytes,
             fmt::format("the packet has {} bytes; a ping has at least {}", packet_.size(), fields::size));
    Sides found = sides();
    if (!found.port && !found.starboard) return std::nullopt;
    const double speed = speedOfSound();
    for (std::optional<Side>* side : {&found.port, &found.starboard})
        if (*side) (*side)->range = rangeOf(**side, speed);
    if (found.port && found.starboard && std::abs(found.port->resolution() / found.starboard->resolution() - 1) > 1e-3)
        fail(
            found.starboard->at,
            fmt::format("the samples are {:.6g} m long, and those to port {:.6g} m; both sides of a ping must be alike",
                        found.starboard->resolution(), found.port->resolution()));
    RecordedPing read;
    read.ping.time = time();
    setBins(found, speed, read);
    const Side& any = found.starboard ? *found.starboard : *found.port;
    const double of_ping = field<uint16_t>(any.header, xtf::channel_header::frequency),
                 of_file = any.channel->frequency_khz;
    read.frequency_khz = of_file > 0 && of_file <= 1e5 ? of_file : of_ping;
    read.sonar = placed(read.ping.time, stated());
    if (const double altitude = floatAt(packet_, fields::altitude); altitude > 0 && altitude <= 12000)
        read.altitude = altitude;
    read.number = field<uint32_t>(packet_, fields::number);
    return read;
}

std::vector<std::string> XtfFile::notices() const {
    std::vector<std::string> all = RecordingReader::notices();
    for (const auto& [type, count] : other_packets_)
        all.push_back(
            fmt::format("{} packets of type {} are omitted: only side-scan pings (type 0) are read", count, type));
    for (const auto& [number, count] : other_channels_)
        all.push_back(fmt::format("channel {} is omitted in {} pings: only the first to port and to starboard are read",
                                  number, count));
    if (without_side_ > 0)
        all.push_back(fmt::format("{} pings have no channel to port or to starboard and are omitted", without_side_));
    return all;
}

}  // namespace insonify::recordings
