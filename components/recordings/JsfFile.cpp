#include "components/recordings/JsfFile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <utility>

namespace insonify::recordings {
namespace {

/** Offsets of a message's fields [B]. */
namespace jsf {
constexpr size_t header = 16, version = 2, type = 4, subsystem = 7, channel = 8, size = 12;
constexpr uint16_t magic = 0x1601, sonar_data = 80;
// A message of type 80 has a second header, of 240 bytes.
constexpr size_t samples = header + 240, seconds = header + 0, first_sample = header + 4, number = header + 8,
                 high_bits = header + 16, low_bits = header + 18, validity = header + 30, format = header + 34,
                 x = header + 80, y = header + 84, units = header + 88, count = header + 114, interval = header + 116,
                 start_frequency = header + 126, end_frequency = header + 128, depth = header + 136,
                 altitude = header + 144, sound_speed = header + 148, year = header + 156, day = header + 158,
                 weight = header + 168, heading = header + 172, pitch = header + 174, roll = header + 176,
                 course = header + 192, milliseconds_today = header + 200;
constexpr int16_t envelope = 0, analytic = 1;  ///< Values of `format`.
enum Validity {
    position = 1,
    course_bit = 2,
    heading_bit = 8,
    attitude = 32,
    altitude_bit = 64,
    depth_bit = 512,
    sound = 1 << 14
};
}  // namespace jsf

bool isValid(std::span<const char> message, int bit) { return field<uint16_t>(message, jsf::validity) & bit; }

/** Returns a number of 16 bits with four more bits above, present since version 10. */
uint32_t extended(std::span<const char> message, size_t at, int shift) {
    const bool has_more = field<uint8_t>(message, jsf::version) >= 10;
    const uint32_t more = has_more ? field<uint16_t>(message, jsf::high_bits) >> shift & 0xF : 0;
    return more << 16 | field<uint16_t>(message, at);
}

}  // namespace

bool JsfFile::isWanted() {
    const int type = field<uint16_t>(packet_, jsf::type), subsystem = field<uint8_t>(packet_, jsf::subsystem);
    if (type != jsf::sonar_data) return ++other_messages_[type], false;
    if (packet_.size() < jsf::samples)
        fail(at_ + jsf::size, fmt::format("the message has {} bytes; sonar data have at least {}",
                                          packet_.size() - jsf::header, jsf::samples - jsf::header));
    const bool is_side_scan = subsystem >= 20 && subsystem <= 22 && field<uint8_t>(packet_, jsf::channel) <= 1;
    if (is_side_scan && !subsystem_) subsystem_ = subsystem;
    if (!is_side_scan || subsystem != subsystem_) return ++other_subsystems_[subsystem], false;
    const int format = field<int16_t>(packet_, jsf::format);
    if (format != jsf::envelope && format != jsf::analytic) return ++other_formats_[format], false;
    return true;
}

std::optional<JsfFile::Side> JsfFile::nextSide() {
    const auto getSize = [&](std::span<const char> head) -> uint64_t {
        if (const auto mark = field<uint16_t>(head, 0); mark != jsf::magic)
            fail(at_, fmt::format("is 0x{:04X}; a message begins with 0x{:04X}", mark, jsf::magic));
        const auto size = field<int32_t>(head, jsf::size);
        if (size < 0) fail(at_ + jsf::size, fmt::format("the message has {} bytes; it must have at least 0", size));
        return jsf::header + static_cast<uint64_t>(size);
    };
    for (packet_ = readPacket(jsf::header, getSize); !packet_.empty(); packet_ = readPacket(jsf::header, getSize))
        if (isWanted()) {
            Side read = side();
            read.message = std::move(packet_);
            return read;
        }
    return std::nullopt;
}

double JsfFile::speedOfSound(const Side& side) const {
    const double speed = static_cast<double>(field<float>(side.message, jsf::sound_speed));
    return isValid(side.message, jsf::sound) && speed >= 1000 && speed <= 2000 ? speed : 1500;
}

JsfFile::Side JsfFile::side() const {
    Side side;
    side.at = at_;
    side.is_port = field<uint8_t>(packet_, jsf::channel) == 0;
    side.is_complex = field<int16_t>(packet_, jsf::format) == jsf::analytic;
    side.number = field<uint32_t>(packet_, jsf::number);
    side.first = field<uint32_t>(packet_, jsf::first_sample);
    side.count = extended(packet_, jsf::count, 8);
    const size_t bytes = side.is_complex ? 4 : 2, left = packet_.size() - jsf::samples;
    if (side.count == 0 || side.count > left / bytes)
        fail(at_ + jsf::count,
             fmt::format("has {} samples of {} bytes; {} bytes are left of the message, and a ping has "
                         "at least one sample",
                         side.count, bytes, left));
    constexpr uint32_t max_first = 65536;
    if (side.first > max_first)
        fail(at_ + jsf::first_sample,
             fmt::format("the samples begin at number {}; at most {} may be before them", side.first, max_first));
    const bool has_fraction = field<uint8_t>(packet_, jsf::version) >= 11;
    const double interval_ns = field<uint32_t>(packet_, jsf::interval) +
                               (has_fraction ? (field<uint16_t>(packet_, jsf::low_bits) & 0xFF) / 256.0 : 0.0);
    if (!(interval_ns > 0 && interval_ns <= 1e9))
        fail(at_ + jsf::interval,
             fmt::format("the sample interval is {:g} ns; it must be above 0 and at most 1 s", interval_ns));
    side.resolution = interval_ns * 1e-9 / 2;  // time, one way; `line` converts it to a range
    return side;
}

types::Time JsfFile::time(const Side& side) const {
    const auto milliseconds = field<uint32_t>(side.message, jsf::milliseconds_today);
    if (const auto seconds = field<int32_t>(side.message, jsf::seconds); seconds > 0)
        return {int64_t{seconds} * 1'000'000 + int64_t{milliseconds % 1000} * 1000};
    std::tm date{};  // older files
    date.tm_year = field<int16_t>(side.message, jsf::year) - 1900;
    date.tm_mday = field<int16_t>(side.message, jsf::day);
    const int64_t midnight = timegm(&date);
    if (date.tm_year < 70 || midnight < 0 || milliseconds >= 86'400'000 || midnight * 1000 + milliseconds == 0)
        fail(side.at + jsf::year,
             fmt::format("neither the time since 1970 nor year {} and day {} give a time after 1970",
                         field<int16_t>(side.message, jsf::year), field<int16_t>(side.message, jsf::day)));
    return {(midnight * 1000 + milliseconds) * 1000};
}

std::optional<RecordingReader::Stated> JsfFile::stated(const Side& side) {
    const std::span<const char> message = side.message;
    const auto units = field<int16_t>(message, jsf::units);
    const bool has_heading = isValid(message, jsf::heading_bit), has_course = isValid(message, jsf::course_bit);
    if (!isValid(message, jsf::position) || (!has_heading && !has_course) || units < 1 || units > 4)
        return std::nullopt;
    constexpr double metres[] = {1e-3, 1 / 600000.0, 0.1, 0.01};  // the second applies to degrees
    const double unit = metres[units - 1];
    Stated stated{units == 2, field<int32_t>(message, jsf::y) * unit, field<int32_t>(message, jsf::x) * unit};
    stated.heading =
        has_heading ? field<uint16_t>(message, jsf::heading) / 100.0 : field<int16_t>(message, jsf::course);
    if (isValid(message, jsf::depth_bit)) stated.depth = field<int32_t>(message, jsf::depth) * 1e-3;
    if (isValid(message, jsf::attitude)) {
        constexpr double degrees = 180.0 / 32768;
        stated.pitch = field<int16_t>(message, jsf::pitch) * degrees;
        stated.roll = field<int16_t>(message, jsf::roll) * degrees;
    }
    return stated;
}

void JsfFile::append(const Side& side, types::Sonar& ping) {
    const int weight = field<int16_t>(side.message, jsf::weight);
    const auto sample = [&](uint32_t i) {
        const size_t at = jsf::samples + i * (side.is_complex ? 4 : 2);
        if (!side.is_complex) return std::ldexp(static_cast<float>(field<uint16_t>(side.message, at)), -weight);
        const float real = field<int16_t>(side.message, at), imaginary = field<int16_t>(side.message, at + 2);
        return std::ldexp(std::hypot(real, imaginary), -weight);
    };
    appendSide(side.is_port, side.first, side.count, sample, ping);
}

RecordedPing JsfFile::line(const Side& a, const Side* b) {
    if (b && std::abs(a.resolution / b->resolution - 1) > 1e-3)
        fail(
            b->at + jsf::interval,
            fmt::format("the sample interval is {:g} ns, and that of the other side {:g} ns; both sides of a ping must "
                        "be alike",
                        b->resolution * 2e9, a.resolution * 2e9));
    RecordedPing read;
    const double speed = speedOfSound(a);
    read.ping.time = time(a);
    setResolution(a.resolution * speed, speed, read);
    read.ping.bin_count = a.first + a.count;
    if (b) read.ping.bin_count = std::max(read.ping.bin_count, b->first + b->count);
    const Side* const port = a.is_port ? &a : b;
    const Side* const starboard = a.is_port ? b : &a;
    if (starboard) append(*starboard, read.ping);
    if (port) append(*port, read.ping);
    read.frequency_khz =
        (extended(a.message, jsf::start_frequency, 0) + extended(a.message, jsf::end_frequency, 4)) / 200.0;
    read.sonar = placed(read.ping.time, stated(a));
    if (isValid(a.message, jsf::altitude_bit))
        read.altitude = std::max(0.0, field<int32_t>(a.message, jsf::altitude) * 1e-3);
    read.number = a.number;
    return read;
}

std::optional<RecordedPing> JsfFile::read() {
    const std::optional<Side> first = waiting_ ? std::exchange(waiting_, std::nullopt) : nextSide();
    if (!first) return std::nullopt;
    waiting_ = nextSide();
    if (!waiting_ || waiting_->number != first->number || waiting_->is_port == first->is_port)
        return line(*first, nullptr);
    const std::optional<Side> second = std::exchange(waiting_, std::nullopt);
    return line(*first, &*second);
}

std::vector<std::string> JsfFile::notices() const {
    std::vector<std::string> all = RecordingReader::notices();
    for (const auto& [type, count] : other_messages_)
        all.push_back(
            fmt::format("{} messages of type {} are omitted: only sonar data (type 80) are read", count, type));
    for (const auto& [number, count] : other_subsystems_)
        all.push_back(fmt::format(
            "{} messages of subsystem {} are omitted: only the first side-scan, 20 to 22, is read", count, number));
    for (const auto& [format, count] : other_formats_)
        all.push_back(fmt::format("{} messages of data format {} are omitted: only 0 and 1 are read", count, format));
    return all;
}

}  // namespace insonify::recordings
