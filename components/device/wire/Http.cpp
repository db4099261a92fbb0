#include "components/device/wire/Http.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <charconv>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <sstream>

namespace insonify::device {

namespace http = boost::beast::http;

namespace {

constexpr uint32_t max_header = 16 << 10;  // [bytes]
constexpr unsigned version = 11;           // 1.1

Bytes toBytes(const std::ostringstream& stream) {
    const std::string text = stream.str();
    return {text.begin(), text.end()};
}

Bytes serialised(auto& message) {
    message.prepare_payload();
    std::ostringstream stream;
    stream << message;
    return toBytes(stream);
}

std::string text(boost::beast::string_view view) { return {view.data(), view.size()}; }

bool take(std::string_view& text, char c) {
    const bool is_there = text.starts_with(c);
    text.remove_prefix(is_there ? 1 : 0);
    return is_there;
}

/** Parses a number at the front of a text, in the C locale, not the host's. */
bool take(std::string_view& text, auto& number, size_t max_characters) {
    const char* const end = text.data() + std::min(max_characters, text.size());
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    text.remove_prefix(static_cast<size_t>(stop - text.data()));
    return error == std::errc();
}

/** Returns the seconds of a zone, Z or +01:00. */
std::optional<int> zoneSeconds(std::string_view zone) {
    if (zone == "Z" || zone == "z") return 0;
    const bool is_west = take(zone, '-');
    int hours = 0, minutes = 0;
    if (!is_west && !take(zone, '+')) return std::nullopt;
    if (!take(zone, hours, 2) || !take(zone, ':') || !take(zone, minutes, 2) || !zone.empty() || hours < 0 ||
        minutes < 0 || hours > 23 || minutes > 59)
        return std::nullopt;
    return (is_west ? -1 : 1) * (hours * 3600 + minutes * 60);
}

bool isOfTheCalendar(const std::tm& day, double second) {
    std::tm again = day;
    return timegm(&again) >= 0 && again.tm_mday == day.tm_mday && again.tm_mon == day.tm_mon && day.tm_hour >= 0 &&
           day.tm_hour < 24 && day.tm_min >= 0 && day.tm_min < 60 && second >= 0 && second < 61;
}

}  // namespace

Bytes httpBytes(const HttpReply& reply, bool keep_alive) {
    http::response<http::string_body> message(static_cast<http::status>(reply.status), version);
    if (!reply.body.empty()) message.set(http::field::content_type, "application/json; charset=utf-8");
    message.keep_alive(keep_alive);
    message.body() = reply.body;
    return serialised(message);
}

Bytes httpBytes(const HttpRequest& request, const std::string& host) {
    http::request<http::string_body> message;
    message.version(version);
    message.method_string(request.method);
    message.target(request.path);
    message.set(http::field::host, host);
    if (!request.body.empty()) message.set(http::field::content_type, "application/json");
    message.keep_alive(request.keep_alive);
    message.body() = request.body;
    return serialised(message);
}

HttpReply httpError(int status, const std::string& text) {
    return {status, nlohmann::json{{"error", text}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

struct HttpReader::Parser {
    Parser() {
        request.eager(true);
        request.body_limit(max_body);
        request.header_limit(max_header);
    }
    http::request_parser<http::string_body> request;
};

HttpReader::HttpReader() : parser_(std::make_unique<Parser>()) {}
HttpReader::~HttpReader() = default;
HttpReader::HttpReader(HttpReader&&) noexcept = default;
HttpReader& HttpReader::operator=(HttpReader&&) noexcept = default;

void HttpReader::add(std::span<const uint8_t> bytes) {
    if (!refusal_) bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

void HttpReader::refuse(int status, const std::string& why) {
    refusal_ = httpError(status, why);
    bytes_.clear();
}

std::optional<HttpRequest> HttpReader::next() {
    if (refusal_ || bytes_.empty()) return std::nullopt;
    boost::beast::error_code error;
    const size_t used = parser_->request.put(boost::asio::buffer(bytes_.data(), bytes_.size()), error);
    if (error == http::error::body_limit)
        refuse(413, "the body is longer than 64 KiB");
    else if (error == http::error::header_limit)
        refuse(431, "the header is longer than 16 KiB");
    else if (error && error != http::error::need_more)
        refuse(400, "this is no request of HTTP/1.1: " + error.message());
    if (refusal_) return std::nullopt;
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(used));
    if (bytes_.size() > max_header + max_body) refuse(431, "the header is longer than 16 KiB");
    if (!parser_->request.is_done()) return std::nullopt;
    const auto message = parser_->request.release();
    parser_ = std::make_unique<Parser>();
    const std::string target = text(message.target());
    return HttpRequest{text(message.method_string()), target.substr(0, target.find('?')), message.body(),
                       message.keep_alive()};
}

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
    std::string_view rest = text;
    const auto readPart = [&](int& part, size_t digits, char end) {
        return take(rest, part, digits) && take(rest, end);
    };
    if (text.size() > 64 || !readPart(day.tm_year, 4, '-') || !readPart(day.tm_mon, 2, '-') ||
        !readPart(day.tm_mday, 2, 'T') || !readPart(day.tm_hour, 2, ':') || !readPart(day.tm_min, 2, ':') ||
        !take(rest, second, 20))
        return std::nullopt;
    const auto zone = zoneSeconds(rest);
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
