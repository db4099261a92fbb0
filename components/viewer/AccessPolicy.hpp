#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace insonify::viewer {

/** Who may have what. */
struct AccessPolicy {
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

    enum class Use {
        File,    ///< Holds no secret: for everybody.
        Page,    ///< Needs the token, where there is one, as what follows.
        Read,    ///< A socket that only reads: without a token not from web pages but ours and Foxglove's own.
        Control  ///< A socket that may change things: without a token from no page but ours.
    };
    std::optional<Refusal> decide(const Request& request, Use use) const;
    /** Whether a Foxglove client that may read may set parameters: without a token programs and our own pages may,
     * other sites none. */
    bool maySet(const Request& request) const;
};

/** The value of `token` in a target's query, with its escapes undone; empty when there is none. */
std::string tokenIn(std::string_view target);

/** A numeric address or localhost, with or without a port: nothing that a name server elsewhere decides. */
bool isOwnName(std::string_view host);

}  // namespace insonify::viewer
