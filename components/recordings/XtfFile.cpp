#include "components/recordings/XtfFile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "components/recordings/XtfLayout.hpp"
#include "types/text/ConfigError.hpp"

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

/** Returns "byte 1280: the channel is 7". */
std::string toText(const types::ConfigError& error) {
    const types::Diagnostic& found = error.diagnostics().front();
    return found.path + ": " + found.message;
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

bool XtfFile::beginsPacket(uint64_t at) {
    const std::vector<char> mark = take(at, sizeof(uint16_t));
    return mark.size() == sizeof(uint16_t) && field<uint16_t>(mark, 0) == xtf::packet::magic;
}

bool XtfFile::describesChannel(uint64_t at) {
    namespace info = xtf::channel_info;
    constexpr uint8_t max_type = 3;  // bathymetry
    const std::vector<char> bytes = take(at, info::size);
    return bytes.size() == info::size && field<uint8_t>(bytes, info::type) <= max_type &&
           sampleBytes(field<uint8_t>(bytes, info::sample_format), field<uint16_t>(bytes, info::sample_bytes)) > 0;
}

void XtfFile::readChannels() {
    namespace header = xtf::file_header;
    namespace info = xtf::channel_info;
    std::vector<char> bytes = take(0, header::size);
    if (bytes.size() < header::size)
        fail(bytes.size(), fmt::format("ends here; an XTF file has a header of {} bytes", header::size));
    in_degrees_ = field<uint16_t>(bytes, header::nav_units) == header::degrees;
    declared_ =
        size_t{field<uint16_t>(bytes, header::channel_count)} + field<uint16_t>(bytes, header::bathymetry_count);
    const size_t needed = header::channel_infos + declared_ * info::size;
    for (next_ = header::size; next_ < needed && !beginsPacket(next_);) next_ += header::size;
    while (!beginsPacket(next_) && describesChannel(next_)) next_ += header::size;  // more than it declares
    bytes = take(0, next_);
    if (bytes.size() < next_)
        fail(header::channel_count,
             fmt::format("has {} channels, whose header is {} bytes; the file has {}", declared_, next_, size_));
    for (size_t at = header::channel_infos; at + info::size <= bytes.size(); at += info::size) {
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
        if (channel.sample_bytes == 0 && isSide(channel.type) && channels_.size() < declared_)
            fail(at + info::sample_format,
                 fmt::format("the samples of channel {} have format {} of {} bytes; it may be 0 (1, 2 or 4 bytes), "
                             "2, 3, 5 or 8",
                             channels_.size(), channel.format, legacy));
        if (channel.sample_bytes == 0 && !isSide(channel.type)) channel.sample_bytes = legacy;
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
        if (const auto type = field<uint8_t>(packet_, xtf::packet::type); type != xtf::packet::sonar) {
            ++other_packets_[type];
            continue;
        }
        try {
            if (auto read = line()) return read;
            ++without_side_;
        } catch (const types::ConfigError& error) {
            omitted_.add(toText(error));
        }
    }
    return std::nullopt;
}

XtfFile::Side XtfFile::side(size_t offset, bool by_header) const {
    namespace fields = xtf::channel_header;
    const uint64_t at = at_ + offset;
    const size_t left = packet_.size() - offset;
    if (left < fields::size)
        fail(at, fmt::format("{} bytes are left of the packet; the header of a channel has {}", left, fields::size));
    Side side;
    side.at = at;
    side.header = std::span<const char>(packet_).subspan(offset, fields::size);
    const auto number = field<uint16_t>(side.header, fields::channel);
    if (number >= channels_.size() || channels_[number].sample_bytes == 0)
        fail(at + fields::channel,
             fmt::format("the channel is {}; the header of the file describes {} channels, from 0", number,
                         std::ranges::count_if(channels_, &Channel::sample_bytes)));
    side.channel = &channels_[number];
    side.count = field<uint32_t>(side.header, fields::sample_count);
    if (side.count == 0 && by_header) side.count = side.channel->sample_count;
    const uint64_t bytes = uint64_t{side.count} * side.channel->sample_bytes;
    if (bytes > left - fields::size)
        fail(at + fields::sample_count,
             fmt::format("the channel has {} samples of {} bytes; {} bytes are left of the packet", side.count,
                         side.channel->sample_bytes, left - fields::size));
    side.samples = std::span<const char>(packet_).subspan(offset + fields::size, static_cast<size_t>(bytes));
    return side;
}

std::vector<XtfFile::Side> XtfFile::channelsOfPing(bool by_header, Failure& failure) const {
    std::vector<Side> all;
    failure.reset();
    size_t offset = xtf::ping_header::size;
    try {
        for (int left = field<uint16_t>(packet_, xtf::packet::channel_count); left > 0; --left) {
            all.push_back(side(offset, by_header));
            offset += all.back().header.size() + all.back().samples.size();
        }
    } catch (const types::ConfigError& error) {
        failure = error;
    }
    return all;
}

XtfFile::Sides XtfFile::sides() {
    Failure failure, by_header_failure;
    std::vector<Side> all = channelsOfPing(false, failure);
    if (std::ranges::none_of(all, &Side::count))
        if (std::vector<Side> old = channelsOfPing(true, by_header_failure); !by_header_failure) {
            all = std::move(old);
            failure.reset();
        }
    Sides found;
    for (const Side& read : all) {
        const auto number = static_cast<size_t>(read.channel - channels_.data());
        auto& place = read.channel->type == xtf::channel_info::port ? found.port : found.starboard;
        if (isSide(read.channel->type) && read.count == 0)
            empty_.add(fmt::format("byte {}", read.at));
        else if (isSide(read.channel->type) && !place)
            place = read;
        else
            ++other_channels_[number];
        if (number >= declared_) ++undeclared_[number];
    }
    const bool has_side = found.port || found.starboard;
    if (failure && !has_side) throw *failure;
    if (failure) cut_short_.add(toText(*failure));
    return found;
}

double XtfFile::computeRange(const Side& side, double speed_of_sound) const {
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

uint32_t XtfFile::Side::binCount(double per_bin) const {
    return static_cast<uint32_t>(std::ceil(count / per_bin - 0.5));
}

void XtfFile::Side::append(double per_bin, bool is_port, types::Sonar& ping) const {
    const int weight = field<int16_t>(header, xtf::channel_header::weight);
    const bool is_float = channel->format == xtf::channel_info::float32;
    const auto sample = [&](uint32_t bin) {
        const uint32_t i = std::min(static_cast<uint32_t>((bin + 0.5) * per_bin), count - 1);
        const uint32_t place = is_port ? count - 1 - i : i;  // port runs from the far end to the sonar
        const float value = sampleAt(samples, place, channel->sample_bytes, is_float);
        return weight == 0 ? value : std::ldexp(value, -weight);
    };
    appendSide(is_port, 0, binCount(per_bin), sample, ping);
}

void XtfFile::setBins(const Sides& sides, double speed_of_sound, RecordedPing& to) {
    const Side& any = sides.starboard ? *sides.starboard : *sides.port;
    const Side& other = sides.port ? *sides.port : any;
    constexpr double alike = 1e-3, max_ratio = 10;
    const double ratio = any.resolution() / other.resolution();  // the finer one gives the bins
    const bool is_resampled = std::abs(ratio - 1) > alike;
    const auto why = [&] {
        return fmt::format("the samples are {:.6g} m long, and those to port {:.6g} m", any.resolution(),
                           other.resolution());
    };
    if (is_resampled && !(ratio <= max_ratio && ratio >= 1 / max_ratio))
        fail(any.at, why() + fmt::format("; one may be at most {:g} times the other", max_ratio));
    if (is_resampled) resampled_.add(fmt::format("byte {}: {}", any.at, why()));
    const double starboard_per_bin = is_resampled && ratio > 1 ? 1 / ratio : 1,
                 port_per_bin = is_resampled && ratio < 1 ? ratio : 1;
    setResolution(is_resampled && ratio > 1 ? other.resolution() : any.resolution(), speed_of_sound, to);
    types::Sonar& ping = to.ping;
    ping.beam_width = any.channel->beam_width;
    ping.beam_height = any.channel->beam_height;
    ping.bin_count = std::max(sides.port ? sides.port->binCount(port_per_bin) : 0,
                              sides.starboard ? sides.starboard->binCount(starboard_per_bin) : 0);
    if (sides.starboard) sides.starboard->append(starboard_per_bin, false, ping);
    if (sides.port) sides.port->append(port_per_bin, true, ping);
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
        if (*side) (*side)->range = computeRange(**side, speed);
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
    for (const auto& [number, count] : undeclared_)
        all.push_back(
            fmt::format("channel {} of {} pings is read as the header describes it, although the header "
                        "declares only {} channels",
                        number, count, declared_));
    if (without_side_ > 0)
        all.push_back(fmt::format("{} pings have no channel to port or to starboard and are omitted", without_side_));
    const auto report = [&](const OddPings& odd, const char* what) {
        if (odd.count > 0) all.push_back(fmt::format("{} {}; the first: {}", odd.count, what, odd.first));
    };
    report(omitted_, "pings are omitted, because they contradict themselves");
    report(cut_short_, "pings are read up to a channel that cannot be read");
    report(empty_, "sides of pings have no samples and are omitted");
    report(resampled_, "pings have samples of two lengths, and get bins of the shorter");
    return all;
}

}  // namespace insonify::recordings
