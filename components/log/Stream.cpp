#include "components/log/Stream.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <sstream>

#include "types/ConfigError.hpp"

namespace insonify::log {
namespace {

constexpr int64_t year_2000 = 946'684'800;  // [s]

bool isNumber(const std::string& text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

/** Parses a date in UTC: 'T' or a blank before the time of day, which may have a fraction and end in Z. */
bool isDate(std::string text, types::Time& time) {
    if (text.ends_with('Z')) text.pop_back();
    if (text.size() < std::size("2026-11-22 12:55:44") - 1) return false;
    if (text[10] == 'T') text[10] = ' ';
    std::istringstream stream(text);
    std::tm date{};
    stream >> std::get_time(&date, "%Y-%m-%d %H:%M:%S");
    if (!stream) return false;
    double fraction = 0;
    if (std::string rest; stream >> rest && (!rest.starts_with('.') || !isNumber("0" + rest, fraction))) return false;
    time = types::Time{int64_t{timegm(&date)} * 1'000'000} + types::Time::fromSeconds(fraction);
    return true;
}

}  // namespace

bool hasDate(types::Time time) { return time.microseconds / 1'000'000 >= year_2000; }

std::string readable(types::Time time) {
    const int64_t seconds = time.microseconds / 1'000'000;
    if (!hasDate(time)) return fmt::format("{:.6f} s", time.seconds());
    return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:06}", fmt::gmtime(static_cast<std::time_t>(seconds)),
                       time.microseconds % 1'000'000);
}

types::Time readTime(const std::string& text, const std::string& what, types::Time start) {
    double seconds = 0;
    if (isNumber(text, seconds) && std::abs(seconds) < 9e12) return start + types::Time::fromSeconds(seconds);
    types::Time time;
    if (isDate(text, time)) return time;
    throw types::ConfigError(
        "", what,
        "is " + text +
            "; it may be the seconds after the log's first stamp, or a date and time in UTC, as in "
            "2026-11-22T12:55:44.5Z");
}

}  // namespace insonify::log
