#include "components/viewer/AccessPolicy.hpp"

#include <arpa/inet.h>

#include <charconv>

namespace insonify::viewer {
namespace {

std::string unescaped(std::string_view text) {
    std::string plain;
    for (size_t i = 0; i < text.size(); ++i) {
        unsigned code = 0;
        const char* const digits = text.data() + i + 1;
        if (text[i] == '%' && i + 2 < text.size() && std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
            plain += static_cast<char>(code);
            i += 2;
        } else {
            plain += text[i];
        }
    }
    return plain;
}

/** Compares in constant time, so that the time does not reveal the place of a difference. */
bool same(const std::string& a, const std::string& b) {
    unsigned difference = a.size() == b.size() ? 0 : 1;
    for (size_t i = 0; i < a.size(); ++i)
        difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b.empty() ? 0 : b[i % b.size()]);
    return difference == 0;
}

/** Returns whether the origin is a web page. Pages that hide their origin send "null"; programs made of pages have
 *  their own schemes. */
bool isSite(std::string_view origin) {
    return origin == "null" || origin.starts_with("http://") || origin.starts_with("https://");
}

bool isFoxglove(std::string_view origin) {
    return origin == "https://app.foxglove.dev" || origin == "https://studio.foxglove.dev";
}

}  // namespace

std::string tokenIn(std::string_view target) {
    size_t at = target.find('?');
    while (at != std::string_view::npos) {
        const size_t end = target.find('&', ++at);
        const std::string_view pair = target.substr(at, end == std::string_view::npos ? end : end - at);
        if (pair.starts_with("token=")) return unescaped(pair.substr(6));
        at = end;
    }
    return "";
}

bool isOwnName(std::string_view host) {
    in6_addr any{};
    if (host.starts_with('[')) {
        const std::string v6(host.substr(1, host.find(']') - 1));
        return inet_pton(AF_INET6, v6.c_str(), &any) == 1;
    }
    const std::string name(host.substr(0, host.find(':')));
    return name == "localhost" || inet_pton(AF_INET, name.c_str(), &any) == 1;
}

std::optional<AccessPolicy::Refusal> AccessPolicy::decide(const Request& request, Use use) const {
    if (!token.empty()) {
        const std::string bearer = "Bearer ";
        const std::string given = request.authorization.starts_with(bearer)
                                      ? request.authorization.substr(bearer.size())
                                      : tokenIn(request.target);
        if (use == Use::File || same(given, token)) return std::nullopt;
        return Refusal{401, "a token is needed: http://address:port/?token=..."};
    }
    if (!isOwnName(request.host))
        return Refusal{403, "the host must be localhost or a numeric address, unless a token is set"};
    const bool is_own = request.origin.empty() || request.origin == "http://" + request.host;
    if ((use == Use::Control && !is_own) ||
        (use == Use::Read && !is_own && isSite(request.origin) && !isFoxglove(request.origin)))
        return Refusal{403, "pages of other origins may not connect, unless a token is set"};
    return std::nullopt;
}

bool AccessPolicy::maySet(const Request& request) const {
    return !token.empty() || !isSite(request.origin) || request.origin == "http://" + request.host;
}

}  // namespace insonify::viewer
