#include "components/log/Stream.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <sstream>
#include <type_traits>

#include "types/Time.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::log {

namespace {

/** Returns a text in quotes, as in JSON. */
std::string quoteJson(const std::string& text) {
    std::string result = "\"";
    for (const char c : text)
        if (c == '"' || c == '\\')
            result += {'\\', c};
        else
            result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    return result + '"';
}

/** Returns a number of the metadata; 0: there is none. */
double numberAt(const Metadata& metadata, const char* key) {
    double number = 0;
    if (const auto found = metadata.find(key); found != metadata.end())
        std::from_chars(found->second.data(), found->second.data() + found->second.size(), number);
    return number;
}

template <class T>
constexpr bool has_bins = std::is_base_of_v<types::RangeBins, T>;

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

void Stream::note(types::Time time) {
    if (count++ == 0) first = last = time;
    if (last - time > types::max_lateness) {
        ++set_backs;
        set_back = set_back + (last - time);
    }
    last = time;
}

void addSampleMetadata(types::SampleView first, Metadata& metadata) {
    const auto add = [&]<class T>(const T* sample) {
        if constexpr (types::NamesObjects<T>) {
            std::string names;
            for (const std::string& name : sample->objects) names += (names.empty() ? "" : ", ") + quoteJson(name);
            metadata[objects_key] = "[" + names + "]";
        }
        if constexpr (has_bins<T>)
            if (sample->bin_width > 0 && sample->writtenSpeed() != sample->speed_of_sound) {
                metadata[bin_width_key] = fmt::format("{}", sample->bin_width);
                metadata[speed_of_sound_key] = fmt::format("{}", sample->speed_of_sound);
            }
    };
    std::visit(add, first);
}

void restoreBins(const Metadata& metadata, types::SampleRoom sample) {
    const auto restore = [&]<class T>(T* held) {
        if constexpr (has_bins<T>)
            if (const double width = numberAt(metadata, bin_width_key), speed = numberAt(metadata, speed_of_sound_key);
                width > 0 && speed > 0)
                held->restore(width, static_cast<float>(speed));
    };
    std::visit(restore, sample);
}

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
