#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace insonify::viewer {

/** Who may have what. */
struct Admission {
    std::string token;  ///< Empty: none is asked for.

    struct Request {
        std::string target;         ///< "/?token=x"
        std::string host, origin;   ///< As sent; empty when absent.
        std::string authorization;  ///< "Bearer x"
    };
    struct Refusal {
        unsigned status;
        std::string reason;
    };

    /** @param secret the request needs the token, where there is one.
     *  @param steers it may change things: without a token it must come from a page of ours. */
    std::optional<Refusal> judge(const Request& request, bool secret, bool steers) const;
};

/** The value of `token` in a target's query, with its escapes undone; empty when there is none. */
std::string tokenIn(std::string_view target);

/** A numeric address or localhost, with or without a port: nothing that a name server elsewhere decides. */
bool isOwnName(std::string_view host);

}  // namespace insonify::viewer
