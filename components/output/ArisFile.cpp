#include "components/output/ArisFile.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/output/ArisBeams.hpp"

namespace insonify::output {
namespace {

namespace aris {
constexpr uint32_t mark = 0x464444, version = 5;  // "DDF" in the lower three bytes, and the version above them
constexpr size_t header = 1024;                   // of the file and of each frame
constexpr size_t pc_time = 4, frame_mark = 12, sonar_time = 20, depth = 128, altitude = 132, pitch = 136, roll = 144,
                 heading = 152, compass_heading = 160, compass_pitch = 164, compass_roll = 168, latitude = 172,
                 longitude = 180, ping_mode = 436, is_high = 440, period = 452, sound_speed = 464, samples = 468,
                 start_delay = 476, lens = 480, model = 484, is_ordered = 516;
constexpr uint32_t max_samples = 65536, max_period_us = 1000, max_delay_us = 1'000'000;
}  // namespace aris

double numberAt(std::span<const char> header, size_t at) { return static_cast<double>(field<float>(header, at)); }

/** Returns the number of beams in a ping mode; 0 for an unknown mode. */
uint32_t beamsOf(uint32_t ping_mode) {
    if (ping_mode == 0 || ping_mode > 12) return 0;
    return ping_mode <= 2 ? 48 : ping_mode <= 5 ? 96 : ping_mode <= 8 ? 64 : 128;
}

/** Returns the higher or the lower of a model's two frequencies, from the maker's data sheets. */
double frequencyOf(ArisModel model, bool is_high) {
    switch (model) {
        case ArisModel::Aris3000: return is_high ? 3000 : 1800;
        case ArisModel::Aris1800: return is_high ? 1800 : 1100;
        case ArisModel::Aris1200: return is_high ? 1200 : 700;
    }
    return 0;
}

}  // namespace

bool ArisFile::isOne(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    char mark[4] = {};
    return file.read(mark, sizeof mark) && (field<uint32_t>(mark, 0) & 0xFFFFFF) == aris::mark;
}

ArisFile::ArisFile(const std::filesystem::path& path) : FanFile(path) {
    const std::vector<char> header = take(0, aris::header);
    if (header.size() < aris::header)
        fail(header.size(), fmt::format("ends here; an ARIS file has a header of {} bytes", aris::header));
    if (const auto mark = field<uint32_t>(header, 0); mark != (aris::mark | aris::version << 24))
        fail(0, fmt::format("is version {} of the format; only version {}, that of the ARIS, is read", mark >> 24,
                            aris::version));
    next_ = aris::header;
}

uint64_t ArisFile::sizeOf(std::span<const char> header) const {
    if (const auto mark = field<uint32_t>(header, aris::frame_mark); mark != (aris::mark | aris::version << 24))
        fail(at_ + aris::frame_mark, fmt::format("is 0x{:08X}; the header of a frame has 0x{:08X} here", mark,
                                                 aris::mark | aris::version << 24));
    const auto mode = field<uint32_t>(header, aris::ping_mode);
    if (beamsOf(mode) == 0) fail(at_ + aris::ping_mode, fmt::format("the ping mode is {}; it may be 1 to 12", mode));
    const auto samples = field<uint32_t>(header, aris::samples);
    if (samples == 0 || samples > aris::max_samples)
        fail(at_ + aris::samples,
             fmt::format("a beam has {} samples; it must have 1 to {}", samples, aris::max_samples));
    return aris::header + uint64_t{samples} * beamsOf(mode);
}

ArisFile::Shape ArisFile::shapeOf(std::span<const char> header) const {
    const auto number = [&](size_t at) { return field<uint32_t>(header, at); };
    if (number(aris::is_ordered) == 0)
        fail(at_ + aris::is_ordered, "the samples are not in the order of beams, which they are in every file");
    const auto model = static_cast<ArisModel>(number(aris::model));
    if (number(aris::model) > 2)
        fail(at_ + aris::model,
             fmt::format("the model is {}; it may be 0 (ARIS 1800), 1 (3000) or 2 (1200)", number(aris::model)));
    Shape shape;
    const uint32_t beams = beamsOf(number(aris::ping_mode));
    shape.bearings = arisBearings(model, beams, number(aris::lens) != 0);
    if (shape.bearings.empty())
        fail(at_ + aris::lens, fmt::format("no bearings are published for {} beams of model {} with this lens", beams,
                                           number(aris::model)));
    const uint32_t period_us = number(aris::period), delay_us = number(aris::start_delay);
    if (period_us == 0 || period_us > aris::max_period_us)
        fail(at_ + aris::period,
             fmt::format("the sample period is {} us; it must be 1 to {}", period_us, aris::max_period_us));
    if (delay_us > aris::max_delay_us)
        fail(at_ + aris::start_delay,
             fmt::format("the samples begin after {} us; at most {} are read", delay_us, aris::max_delay_us));
    shape.first = (delay_us + period_us / 2) / period_us;
    if (shape.first + number(aris::samples) > aris::max_samples)
        fail(at_ + aris::start_delay, fmt::format("the samples begin after {} bins and are {}; together they may be {}",
                                                  shape.first, number(aris::samples), aris::max_samples));
    shape.period = period_us * 1e-6;
    shape.speed = numberAt(header, aris::sound_speed);
    if (shape.speed == 0) shape.speed = 1500;
    if (!(shape.speed >= 1000 && shape.speed <= 2000))
        fail(at_ + aris::sound_speed,
             fmt::format("the speed of sound is {:g} m/s; it may be 1000 to 2000, or 0 for unknown", shape.speed));
    shape.frequency_khz = frequencyOf(model, number(aris::is_high) != 0);
    return shape;
}

types::Time ArisFile::timeOf(std::span<const char> header) const {
    const auto by_pc = field<uint64_t>(header, aris::pc_time);
    const size_t at = by_pc != 0 ? aris::pc_time : aris::sonar_time;
    const auto time = field<uint64_t>(header, at);
    if (const std::string wrong = diagnosticOf(static_cast<double>(time)); !wrong.empty()) fail(at_ + at, wrong);
    return {static_cast<int64_t>(time)};
}

std::optional<RecordedFile::Stated> ArisFile::stated(std::span<const char> header) {
    const auto number = [&](size_t at) { return numberAt(header, at); };
    const double north = field<double>(header, aris::latitude), east = field<double>(header, aris::longitude);
    const bool has_place = north != 0 || east != 0;
    const bool has_compass = std::ranges::any_of(
        std::initializer_list<size_t>{aris::compass_heading, aris::compass_pitch, aris::compass_roll},
        [&](size_t at) { return number(at) != 0; });
    Stated stated{has_place, north, east, number(aris::depth)};
    stated.heading = number(has_compass ? aris::compass_heading : aris::heading);
    stated.pitch = number(has_compass ? aris::compass_pitch : aris::pitch);
    stated.roll = number(has_compass ? aris::compass_roll : aris::roll);
    const bool has_any = has_place || stated.depth != 0 || stated.heading != 0 || stated.pitch != 0 || stated.roll != 0;
    if (!has_any) return std::nullopt;
    if (!has_place_) has_place_ = has_place;
    if (has_place != *has_place_) return std::nullopt;
    return stated;
}

std::optional<FanFrame> ArisFile::read() {
    const std::vector<char> frame =
        takePacket(aris::header, [&](std::span<const char> header) { return sizeOf(header); });
    if (frame.empty()) return std::nullopt;
    const std::span<const char> header = std::span(frame).first(aris::header);
    const Shape shape = shapeOf(header);
    FanFrame found;
    found.ping.time = timeOf(header);
    setResolution(shape.period * shape.speed / 2, shape.speed, found.ping);
    std::vector<double> bearings;
    for (const double bearing : shape.bearings) bearings.push_back(types::radians(bearing));
    setBins(bearings, shape.first, std::span(frame).subspan(aris::header), found.ping);
    found.window_start = found.ping.binStart(shape.first);
    found.frequency_khz = shape.frequency_khz;
    found.sonar = placed(found.ping.time, stated(header));
    if (const double altitude = numberAt(header, aris::altitude); altitude > 0 && altitude <= 12000)
        found.altitude = altitude;
    return found;
}

}  // namespace insonify::output
