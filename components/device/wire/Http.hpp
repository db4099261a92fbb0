#pragma once
// HTTP/1.1 on bytes, and times in its bodies, as far as a device's API needs them.
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "components/device/wire/Bytes.hpp"
#include "types/Time.hpp"

namespace insonify::device {

struct HttpRequest {
    std::string method;  ///< GET, POST, ...
    std::string path;    ///< Without the query after a question mark.
    std::string body;
    bool keep_alive = true;
};

struct HttpReply {
    int status = 204;
    std::string body;  ///< JSON, or nothing.
};

/** Returns the bytes of a reply; `keep_alive`: whether the connection stays open. */
Bytes httpBytes(const HttpReply& reply, bool keep_alive);
/** Returns the bytes of a client's request. */
Bytes httpBytes(const HttpRequest& request, const std::string& host);

/** Reads requests from the bytes of one connection. */
class HttpReader {
public:
    static constexpr size_t max_body = size_t{64} << 10;  ///< [bytes]

    HttpReader();
    ~HttpReader();
    HttpReader(HttpReader&&) noexcept;
    HttpReader& operator=(HttpReader&&) noexcept;

    void add(std::span<const uint8_t> bytes);
    /** Returns the next complete request. */
    std::optional<HttpRequest> next();
    /** Returns the reply to bytes that are not a request, after which the connection ends; none: no error so far. */
    const std::optional<HttpReply>& refusal() const { return refusal_; }

private:
    struct Parser;
    void refuse(int status, const std::string& why);

    std::unique_ptr<Parser> parser_;
    Bytes bytes_;
    std::optional<HttpReply> refusal_;
};

/** Returns `{"error": text}` with this status. */
HttpReply httpError(int status, const std::string& text);

/** Returns a time in ISO 8601, in UTC: 2026-11-23T03:10:05.250000Z. */
std::string isoText(types::Time time);
/** Parses a time with a zone, Z or +01:00, and any number of digits of a second; none for other texts. */
std::optional<types::Time> isoTime(const std::string& text);

}  // namespace insonify::device
