#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace insonify::viewer {

/** Decides which requests are allowed. */
struct AccessPolicy {
    std::string token;  ///< Empty: not required.

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
        File,    ///< Contains no secret: allowed for everybody.
        Page,    ///< Requires the token, if there is one, like the following uses.
        Read,    ///< A read-only socket: without a token, of web pages only this server's and Foxglove's may open it.
        Control  ///< A socket that may change things: without a token, only this server's pages may open it.
    };
    std::optional<Refusal> decide(const Request& request, Use use) const;
    /** Returns whether a Foxglove client that may read may also set parameters. Without a token, programs and this
     *  server's pages may, other sites may not. */
    bool maySet(const Request& request) const;
};

/** Returns the unescaped value of `token` in a target's query; empty if absent. */
std::string tokenIn(std::string_view target);

/** Returns whether the host is localhost or a numeric address, with or without a port, so that no name server decides
 *  it. */
bool isOwnName(std::string_view host);

}  // namespace insonify::viewer
