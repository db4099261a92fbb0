#include "components/device/Http.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

namespace insonify::device {

namespace http = boost::beast::http;

namespace {

constexpr uint32_t max_header = 16 << 10;  // [bytes]
constexpr unsigned version = 11;           // 1.1

Bytes bytesOf(const std::ostringstream& stream) {
    const std::string text = stream.str();
    return {text.begin(), text.end()};
}

template <class Message>
Bytes serialised(Message& message) {
    message.prepare_payload();
    std::ostringstream stream;
    stream << message;
    return bytesOf(stream);
}

std::string text(boost::beast::string_view view) { return {view.data(), view.size()}; }

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
    using Json = nlohmann::json;
    return {status, Json{{"error", text}}.dump(-1, ' ', false, Json::error_handler_t::replace)};
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

}  // namespace insonify::device
