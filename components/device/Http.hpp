#pragma once
// HTTP/1.1 on bytes, and moments in its bodies, as far as a device's API needs them.
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "components/device/Bytes.hpp"
#include "types/Time.hpp"

namespace insonify::device {

struct HttpRequest {
    std::string method;  ///< GET, POST, ...
    std::string path;    ///< Without what follows a question mark.
    std::string body;
    bool keep_alive = true;
};

struct HttpReply {
    int status = 204;
    std::string body;  ///< JSON, or nothing.
};

/** The bytes of a reply; `keep_alive`: whether the connection goes on. */
Bytes httpBytes(const HttpReply& reply, bool keep_alive);
/** Those of a request, as a client sends it. */
Bytes httpBytes(const HttpRequest& request, const std::string& host);

/** Takes requests out of the bytes of one connection, as they come. */
class HttpReader {
public:
    static constexpr size_t max_body = size_t{64} << 10;  ///< [bytes]

    HttpReader();
    ~HttpReader();
    HttpReader(HttpReader&&) noexcept;
    HttpReader& operator=(HttpReader&&) noexcept;

    void add(std::span<const uint8_t> bytes);
    /** The next whole request. */
    std::optional<HttpRequest> next();
    /** What to answer to bytes that are no request, after which the connection ends; none: all was good so far. */
    const std::optional<HttpReply>& refusal() const { return refusal_; }

private:
    struct Parser;
    void refuse(int status, const std::string& why);

    std::unique_ptr<Parser> parser_;
    Bytes bytes_;
    std::optional<HttpReply> refusal_;
};

/** `{"error": text}` with this status. */
HttpReply httpError(int status, const std::string& text);

/** A moment as ISO 8601 writes it in UTC: 2026-11-23T03:10:05.250000Z. */
std::string isoText(types::Time time);
/** With a zone, Z or +01:00, and any digits of a second; none where it is no such text. */
std::optional<types::Time> isoTime(const std::string& text);

}  // namespace insonify::device
