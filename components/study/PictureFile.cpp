#include "components/study/PictureFile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>

#include "components/output/PictureFiles.hpp"
#include "types/geometry/Angle.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::study {
namespace {

namespace fs = std::filesystem;

/** A picture as it is read. */
struct Levels {
    size_t width, height;
    std::vector<uint8_t> values;  ///< Row by row from the top.

    uint8_t at(double column, double row) const {
        const auto x = std::clamp(std::lround(column), 0l, static_cast<long>(width) - 1);
        const auto y = std::clamp(std::lround(row), 0l, static_cast<long>(height) - 1);
        return values[static_cast<size_t>(y) * width + static_cast<size_t>(x)];
    }
};

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
    throw types::ConfigError(file.string(), "--real", why);
}

Levels readLevels(const fs::path& file) try {
    const types::Image image = output::readPng(file);
    return {image.size.width, image.size.height, image.image};
} catch (const std::runtime_error& error) {
    refuse(file, error.what());
}

/** Returns the fan of the given numbers that fills a picture, where no outline was found. */
FanOutline fillPicture(const Levels& levels, const PictureConfig& config) {
    FanOutline fan;
    fan.half_angle = types::radians(config.field_of_view_deg / 2);
    fan.radius = static_cast<double>(levels.height) / (1 - config.range_min / config.range * std::cos(fan.half_angle));
    fan.nearest = fan.radius * config.range_min / config.range;
    fan.column = (static_cast<double>(levels.width) - 1) / 2;
    fan.row = fan.radius - 0.5;
    return fan;
}

/** Returns the ping without codes. @param far number of bins to the far edge */
CodedPing makePing(const PictureConfig& config, const receiver::CodeConfig& law, size_t beams, size_t far,
                   double field_of_view) {
    CodedPing ping{.name = "recorded_0", .beam_count = beams, .bin_count = far, .law = law, .law_known = false};
    ping.law.bits = ping.bits = 8;
    ping.resolution = config.range / static_cast<double>(far);
    const double step = field_of_view / static_cast<double>(beams);
    for (size_t beam = 0; beam < beams; ++beam)
        ping.bearings.push_back((static_cast<double>(beam) + 0.5) * step - field_of_view / 2);
    ping.codes.assign(beams * far, 0);
    return ping;
}

CodedPing readFan(const Levels& levels, const FanOutline& fan, const PictureConfig& config,
                  const receiver::CodeConfig& law) {
    const auto far = static_cast<size_t>(std::max(1L, std::lround(fan.radius)));
    const size_t beams = config.beams > 0 ? config.beams : static_cast<size_t>(fan.half_angle * fan.radius);
    CodedPing ping = makePing(config, law, std::max<size_t>(beams, 1), far, 2 * fan.half_angle);
    for (size_t beam = 0; beam < ping.beam_count; ++beam)
        for (size_t bin = 0; bin < far; ++bin) {
            const double radius = (static_cast<double>(bin) + 0.5) * fan.radius / static_cast<double>(far);
            if (radius < fan.nearest) continue;
            const double bearing = ping.bearings[beam];
            const uint8_t code =
                levels.at(fan.column - radius * std::sin(bearing), fan.row - radius * std::cos(bearing));
            ping.codes[beam * far + bin] = static_cast<float>(code) / 255;
        }
    return ping;
}

CodedPing readPolar(const Levels& levels, const PictureConfig& config, const receiver::CodeConfig& law) {
    const double row = (config.range - config.range_min) / static_cast<double>(levels.height);
    const auto near = static_cast<size_t>(std::lround(config.range_min / row));
    CodedPing ping =
        makePing(config, law, levels.width, near + levels.height, types::radians(config.field_of_view_deg));
    for (size_t beam = 0; beam < levels.width; ++beam)
        for (size_t k = 0; k < levels.height; ++k)
            ping.codes[beam * ping.bin_count + near + k] =
                static_cast<float>(levels.values[(levels.height - 1 - k) * levels.width + (levels.width - 1 - beam)]) /
                255;
    return ping;
}

}  // namespace

bool isPicture(const fs::path& file) {
    std::array<char, 4> bytes{};
    std::ifstream(file, std::ios::binary).read(bytes.data(), bytes.size());
    return bytes == std::array<char, 4>{'\x89', 'P', 'N', 'G'};
}

std::optional<FanOutline> findOutline(const std::vector<uint8_t>& levels, size_t width, size_t height) {
    if (width < 8 || height < 8) return std::nullopt;
    const uint8_t outside = levels[0];
    for (const size_t corner : {width - 1, (height - 1) * width, height * width - 1})
        if (levels[corner] != outside) return std::nullopt;
    // The left edge: its widest row, where far edge and side meet, and its lowest, where side and near edge meet.
    double left = static_cast<double>(width), right = 0, top = 0, widest = 0, low_left = 0, low_right = 0, lowest = -1;
    bool has_top = false;
    for (size_t y = 0; y < height; ++y) {
        const auto row = levels.begin() + static_cast<std::ptrdiff_t>(y * width),
                   end = row + static_cast<std::ptrdiff_t>(width);
        const auto first = std::find_if(row, end, [&](uint8_t level) { return level != outside; });
        if (first == end) continue;
        const auto last = std::find_if(std::make_reverse_iterator(end), std::make_reverse_iterator(row),
                                       [&](uint8_t level) { return level != outside; });
        const auto from = static_cast<double>(first - row), to = static_cast<double>(last.base() - row - 1);
        if (!has_top) top = static_cast<double>(y), has_top = true;
        if (from < left) left = from, widest = static_cast<double>(y);
        right = std::max(right, to);
        low_left = from, low_right = to, lowest = static_cast<double>(y);
    }
    const double tangent = (low_left - left) / (lowest - widest);
    if (!has_top || !(lowest > widest) || !(tangent > 0) || !(right > left)) return std::nullopt;
    FanOutline fan;
    fan.half_angle = std::atan(tangent);
    fan.column = (left + right) / 2;
    fan.row = lowest + (low_right - low_left) / 2 / tangent;
    fan.radius = fan.row - top + 0.5;
    fan.nearest = (fan.row - lowest) / std::cos(fan.half_angle);
    return fan;
}

CodedPing readPicture(const fs::path& file, const PictureConfig& given, const receiver::CodeConfig& law) {
    PictureConfig config = given;
    const Levels levels = readLevels(file);
    std::optional<FanOutline> fan;
    if (config.is_fan.value_or(true)) fan = findOutline(levels.values, levels.width, levels.height);
    if (config.range <= 0) refuse(file, "is a picture; give --range, the slant range of its far edge [m]");
    if (config.range_min >= config.range)
        refuse(file,
               fmt::format("--range-min is {:g} m; must be below --range, {:g} m", config.range_min, config.range));
    if (!fan && config.field_of_view_deg <= 0)
        refuse(file,
               "is a picture without the outline of a fan; give --field-of-view-deg, the angle between its sides");
    if (!fan && config.is_fan.value_or(false)) fan = fillPicture(levels, config);
    if (fan && config.field_of_view_deg > 0) fan->half_angle = types::radians(config.field_of_view_deg / 2);
    CodedPing ping = fan ? readFan(levels, *fan, config, law) : readPolar(levels, config, law);
    ping.file = file.string();
    return ping;
}

}  // namespace insonify::study
