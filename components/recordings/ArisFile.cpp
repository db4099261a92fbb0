#include "components/recordings/ArisFile.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace insonify::recordings {
namespace {

constexpr double aris_3000_128[] = {
    -15.0068, -14.7768, -14.5462, -14.315,  -14.0833, -13.8511, -13.6186, -13.3858, -13.1528, -12.9196, -12.6861,
    -12.4523, -12.2182, -11.9838, -11.7491, -11.5141, -11.2789, -11.0435, -10.8079, -10.5721, -10.3361, -10.0999,
    -9.8635,  -9.6269,  -9.3902,  -9.1534,  -8.9165,  -8.6795,  -8.4424,  -8.2053,  -7.9682,  -7.731,   -7.4938,
    -7.2566,  -7.0193,  -6.782,   -6.5446,  -6.3072,  -6.0698,  -5.8324,  -5.5949,  -5.3574,  -5.1199,  -4.8823,
    -4.6447,  -4.4071,  -4.1695,  -3.9318,  -3.6941,  -3.4564,  -3.2187,  -2.9809,  -2.743,   -2.505,   -2.2669,
    -2.0287,  -1.7904,  -1.552,   -1.3135,  -1.0749,  -0.8362,  -0.5974,  -0.3585,  -0.1196,  0.1194,   0.3584,
    0.5973,   0.8362,   1.075,    1.3137,   1.5523,   1.7908,   2.0292,   2.2675,   2.5057,   2.7438,   2.9818,
    3.2197,   3.4575,   3.6952,   3.9329,   4.1706,   4.4083,   4.6459,   4.8835,   5.1211,   5.3587,   5.5962,
    5.8337,   6.0712,   6.3086,   6.546,    6.7834,   7.0208,   7.2581,   7.4954,   7.7326,   7.9698,   8.207,
    8.4441,   8.6812,   8.9183,   9.1553,   9.3922,   9.629,    9.8657,   10.1023,  10.3387,  10.5749,  10.8109,
    11.0467,  11.2823,  11.5177,  11.7529,  11.9879,  12.2226,  12.457,   12.6911,  12.9249,  13.1584,  13.3916,
    13.6246,  13.8574,  14.0899,  14.3221,  14.5538,  14.785,   15.0156};
constexpr double aris_3000_64[] = {
    -14.8872, -14.4266, -13.9637, -13.499, -13.0332, -12.5665, -12.0986, -11.6295, -11.1593, -10.6883, -10.2165,
    -9.7439,  -9.2706,  -8.7969,  -8.3228, -7.8486,  -7.3742,  -6.8997,  -6.425,   -5.9502,  -5.4753,  -5.0003,
    -4.5251,  -4.0499,  -3.5745,  -3.0991, -2.6234,  -2.1473,  -1.6708,  -1.1939,  -0.7166,  -0.2389,  0.2389,
    0.7166,   1.1939,   1.6708,   2.1473,  2.6234,   3.0991,   3.5745,   4.0499,   4.5251,   5.0003,   5.4753,
    5.9502,   6.425,    6.8997,   7.3742,  7.8486,   8.3228,   8.7969,   9.2706,   9.7439,   10.2165,  10.6883,
    11.1593,  11.6295,  12.0986,  12.5665, 13.0332,  13.499,   13.9637,  14.4266,  14.8872};
constexpr double aris_1800_96[] = {
    -13.749,  -13.5347, -13.3174, -13.0975, -12.8758, -12.6498, -12.4197, -12.1855, -11.9476, -11.7069, -11.4636,
    -11.2173, -10.9676, -10.7144, -10.4579, -10.1985, -9.9352,  -9.668,   -9.3961,  -9.1195,  -8.8385,  -8.5535,
    -8.2654,  -7.9738,  -7.6781,  -7.3793,  -7.0774,  -6.7727,  -6.4652,  -6.1549,  -5.8416,  -5.5246,  -5.2046,
    -4.8824,  -4.5578,  -4.231,   -3.9019,  -3.5711,  -3.2387,  -2.9044,  -2.5686,  -2.2314,  -1.8925,  -1.5519,
    -1.2098,  -0.8664,  -0.5216,  -0.1757,  0.1706,   0.5169,   0.8628,   1.2076,   1.551,    1.8931,   2.2337,
    2.5726,   2.9098,   3.2456,   3.5799,   3.9123,   4.2431,   4.5722,   4.899,    5.2236,   5.5458,   5.8658,
    6.1828,   6.4961,   6.8064,   7.1139,   7.4186,   7.7205,   8.0193,   8.315,    8.6066,   8.8947,   9.1797,
    9.4607,   9.7373,   10.0092,  10.2764,  10.5397,  10.7991,  11.0556,  11.3088,  11.5585,  11.8048,  12.0481,
    12.2888,  12.5267,  12.7609,  12.991,   13.217,   13.4387,  13.6586,  13.8759};
constexpr double aris_48[] = {
    -13.5735, -13.1419, -12.7003, -12.2442, -11.7721, -11.2881, -10.7921, -10.2824, -9.7597, -9.2206, -8.663,  -8.0899,
    -7.5026,  -6.9019,  -6.2897,  -5.6661,  -5.0291,  -4.3823,  -3.7264,  -3.0632,  -2.3931, -1.717,  -1.0343, -0.3461,
    0.3461,   1.0343,   1.717,    2.3931,   3.0632,   3.7264,   4.3823,   5.0291,   5.6661,  6.2897,  6.9019,  7.5026,
    8.0899,   8.663,    9.2206,   9.7597,   10.2824,  10.7921,  11.2881,  11.7721,  12.2442, 12.7003, 13.1419, 13.5735};
constexpr double telephoto_96[] = {
    -7.419, -7.271, -7.123, -6.974, -6.824, -6.674, -6.523, -6.372, -6.22,  -6.068, -5.915, -5.763, -5.609, -5.456,
    -5.302, -5.148, -4.993, -4.838, -4.682, -4.526, -4.37,  -4.213, -4.055, -3.897, -3.739, -3.581, -3.422, -3.264,
    -3.105, -2.947, -2.788, -2.63,  -2.471, -2.313, -2.154, -1.995, -1.836, -1.677, -1.518, -1.359, -1.199, -1.039,
    -0.88,  -0.72,  -0.56,  -0.4,   -0.24,  -0.08,  0.08,   0.24,   0.4,    0.56,   0.72,   0.88,   1.039,  1.199,
    1.359,  1.518,  1.677,  1.836,  1.995,  2.154,  2.313,  2.471,  2.63,   2.788,  2.947,  3.105,  3.264,  3.422,
    3.581,  3.739,  3.897,  4.055,  4.213,  4.37,   4.526,  4.682,  4.838,  4.993,  5.148,  5.302,  5.456,  5.609,
    5.763,  5.915,  6.068,  6.22,   6.372,  6.523,  6.674,  6.824,  6.974,  7.123,  7.271,  7.419};
constexpr double telephoto_48[] = {-7.339, -7.043, -6.744, -6.443, -6.14,  -5.835, -5.529, -5.222, -4.913, -4.602,
                                   -4.29,  -3.975, -3.659, -3.342, -3.025, -2.708, -2.391, -2.074, -1.756, -1.438,
                                   -1.119, -0.8,   -0.48,  -0.16,  0.16,   0.48,   0.8,    1.119,  1.438,  1.756,
                                   2.074,  2.391,  2.708,  3.025,  3.342,  3.659,  3.975,  4.29,   4.602,  4.913,
                                   5.222,  5.529,  5.835,  6.14,   6.443,  6.744,  7.043,  7.339};

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
uint32_t getBeams(uint32_t ping_mode) {
    if (ping_mode == 0 || ping_mode > 12) return 0;
    return ping_mode <= 2 ? 48 : ping_mode <= 5 ? 96 : ping_mode <= 8 ? 64 : 128;
}

/** Returns the higher or the lower of a model's two frequencies, from the maker's data sheets. */
double getFrequency(ArisModel model, bool is_high) {
    switch (model) {
        case ArisModel::Aris3000: return is_high ? 3000 : 1800;
        case ArisModel::Aris1800: return is_high ? 1800 : 1100;
        case ArisModel::Aris1200: return is_high ? 1200 : 700;
    }
    return 0;
}

}  // namespace

std::span<const double> arisBearings(ArisModel model, uint32_t beams, bool is_telephoto) {
    if (model == ArisModel::Aris3000) {
        if (is_telephoto) return {};  // no table is published
        return beams == 128  ? std::span<const double>(aris_3000_128)
               : beams == 64 ? std::span<const double>(aris_3000_64)
                             : std::span<const double>();
    }
    if (beams == 48) return is_telephoto ? telephoto_48 : aris_48;
    if (beams == 96 && model == ArisModel::Aris1800) return is_telephoto ? telephoto_96 : aris_1800_96;
    return {};
}

ArisFile::ArisFile(const std::filesystem::path& path) : RecordingReader(path) {
    const std::vector<char> header = take(0, aris::header);
    if (header.size() < aris::header)
        fail(header.size(), fmt::format("ends here; an ARIS file has a header of {} bytes", aris::header));
    if (const auto mark = field<uint32_t>(header, 0); mark != (aris::mark | aris::version << 24))
        fail(0, fmt::format("is version {} of the format; only version {}, that of the ARIS, is read", mark >> 24,
                            aris::version));
    next_ = aris::header;
}

uint64_t ArisFile::getSize(std::span<const char> header) const {
    if (const auto mark = field<uint32_t>(header, aris::frame_mark); mark != (aris::mark | aris::version << 24))
        fail(at_ + aris::frame_mark, fmt::format("is 0x{:08X}; the header of a frame has 0x{:08X} here", mark,
                                                 aris::mark | aris::version << 24));
    const auto mode = field<uint32_t>(header, aris::ping_mode);
    if (getBeams(mode) == 0) fail(at_ + aris::ping_mode, fmt::format("the ping mode is {}; it may be 1 to 12", mode));
    const auto samples = field<uint32_t>(header, aris::samples);
    if (samples == 0 || samples > aris::max_samples)
        fail(at_ + aris::samples,
             fmt::format("a beam has {} samples; it must have 1 to {}", samples, aris::max_samples));
    return aris::header + uint64_t{samples} * getBeams(mode);
}

ArisFile::Shape ArisFile::getShape(std::span<const char> header) const {
    const auto number = [&](size_t at) { return field<uint32_t>(header, at); };
    if (number(aris::is_ordered) == 0)
        fail(at_ + aris::is_ordered, "the samples are not in the order of beams, which they are in every file");
    const auto model = static_cast<ArisModel>(number(aris::model));
    if (number(aris::model) > 2)
        fail(at_ + aris::model,
             fmt::format("the model is {}; it may be 0 (ARIS 1800), 1 (3000) or 2 (1200)", number(aris::model)));
    Shape shape;
    const uint32_t beams = getBeams(number(aris::ping_mode));
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
    shape.frequency_khz = getFrequency(model, number(aris::is_high) != 0);
    return shape;
}

types::Time ArisFile::getTime(std::span<const char> header) const {
    const auto by_pc = field<uint64_t>(header, aris::pc_time);
    const size_t at = by_pc != 0 ? aris::pc_time : aris::sonar_time;
    const auto time = field<uint64_t>(header, at);
    if (const std::string wrong = findDiagnostic(static_cast<double>(time)); !wrong.empty()) fail(at_ + at, wrong);
    return {static_cast<int64_t>(time)};
}

std::optional<RecordingReader::Stated> ArisFile::stated(std::span<const char> header) {
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

std::optional<RecordedPing> ArisFile::read() {
    const std::vector<char> frame =
        readPacket(aris::header, [&](std::span<const char> header) { return getSize(header); });
    if (frame.empty()) return std::nullopt;
    const std::span<const char> header = std::span(frame).first(aris::header);
    const Shape shape = getShape(header);
    RecordedPing found;
    found.ping.time = getTime(header);
    setResolution(shape.period * shape.speed / 2, shape.speed, found);
    std::vector<double> bearings;
    for (const double bearing : shape.bearings) bearings.push_back(types::radians(bearing));
    setFan(bearings, shape.first, std::span(frame).subspan(aris::header), found);
    found.code = {.bits = 8, .law = receiver::CodeLaw::Log, .dynamic_range_db = 80};
    found.law_known = true;
    found.window_start = found.ping.binStart(shape.first);
    found.frequency_khz = shape.frequency_khz;
    found.sonar = placed(found.ping.time, stated(header));
    if (const double altitude = numberAt(header, aris::altitude); altitude > 0 && altitude <= 12000)
        found.altitude = altitude;
    return found;
}

}  // namespace insonify::recordings
