#include "components/device/IsoTime.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace insonify::device {
namespace {

/** Of a zone, Z or +01:00 [s]. */
std::optional<int> zoneSeconds(const std::string& zone) {
    if (zone == "Z" || zone == "z") return 0;
    char sign = 0;
    int hours = 0, minutes = 0, length = 0;
    if (std::sscanf(zone.c_str(), "%c%2d:%2d%n", &sign, &hours, &minutes, &length) != 3) return std::nullopt;
    if (static_cast<size_t>(length) != zone.size() || (sign != '+' && sign != '-') || hours < 0 || minutes < 0 ||
        hours > 23 || minutes > 59)
        return std::nullopt;
    return (sign == '-' ? -1 : 1) * (hours * 3600 + minutes * 60);
}

bool isOfTheCalendar(const std::tm& day, double second) {
    std::tm again = day;
    return timegm(&again) >= 0 && again.tm_mday == day.tm_mday && again.tm_mon == day.tm_mon && day.tm_hour >= 0 &&
           day.tm_hour < 24 && day.tm_min >= 0 && day.tm_min < 60 && second >= 0 && second < 61;
}

}  // namespace

std::string isoText(types::Time time) {
    const std::time_t seconds = time.microseconds / 1'000'000;
    std::tm day{};
    gmtime_r(&seconds, &day);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}Z", day.tm_year + 1900, day.tm_mon + 1, day.tm_mday,
                       day.tm_hour, day.tm_min, day.tm_sec, time.microseconds % 1'000'000);
}

std::optional<types::Time> isoTime(const std::string& text) {
    std::tm day{};
    double second = 0;
    int length = 0;
    if (text.size() > 64 || std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%20lf%n", &day.tm_year, &day.tm_mon,
                                        &day.tm_mday, &day.tm_hour, &day.tm_min, &second, &length) != 6)
        return std::nullopt;
    const auto zone = zoneSeconds(text.substr(static_cast<size_t>(length)));
    day.tm_year -= 1900;
    day.tm_mon -= 1;
    if (!std::isfinite(second)) return std::nullopt;
    day.tm_sec = static_cast<int>(std::clamp(second, 0.0, 60.0));
    if (!zone || !isOfTheCalendar(day, second)) return std::nullopt;
    const types::Time time{(static_cast<int64_t>(timegm(&day)) - *zone) * 1'000'000 +
                           std::llround((second - std::floor(second)) * 1e6)};
    return time < types::Time{} ? std::nullopt : std::optional(time);
}

}  // namespace insonify::device
