#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "components/viewer/Foxglove.hpp"
#include "components/viewer/Frame.hpp"

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

inline constexpr const char* page_protocol = "insonify.view.v1";

struct PageFile {
    std::string_view type, content;  ///< MIME type, text.
};
/** Returns a file of the page, all of which are compiled into the program; "/" is the page itself. */
std::optional<PageFile> pageFile(std::string_view path);

/** Callbacks of a server, called on its thread. */
class ServerHandler {
public:
    virtual ~ServerHandler() = default;
    virtual std::optional<PageFile> file(std::string_view path) = 0;
    /** Returns the first messages for a page. */
    virtual std::vector<Frame> greeting() = 0;
    /** Handles a page's request; the answer is passed to Server::reply(). */
    virtual void request(uint64_t client, std::string text) = 0;
    /** Handles a Foxglove client's request to get or set parameters; setting requires `may_set`. */
    virtual void parameters(uint64_t client, ParameterRequest request, bool may_set) = 0;
    /** A Foxglove client has subscribed to these channels, and has received nothing of them yet. */
    virtual void subscribed(const std::vector<uint32_t>& channels) = 0;
    /** A client has subscribed to parameters, and has received none yet. */
    virtual void subscribedToParameters() = 0;
};

struct ServerOptions {
    std::string address = "127.0.0.1";
    uint16_t port = 0;
    std::string token;         ///< Empty: not required.
    size_t clients = 16;       ///< Pages and Foxglove clients together [1].
    double idle_timeout = 30;  ///< [s]
    std::vector<FoxgloveChannel> channels;
    std::string session;  ///< See serverInfo().
};

/** Reports that the server cannot listen. */
struct ListenError : std::runtime_error {
    ListenError(const char* culprit, const std::string& what) : std::runtime_error(what), property(culprit) {}
    const char* property;  ///< The property to change: "port" or "address".
};

struct ServerCounts {
    uint64_t clients = 0;  ///< Connected now.
    /** Connections since the start that were refused, or closed for misbehaviour. Reasons: too many clients; a wrong
     *  token, origin or host; no HTTP; no complete request within 5 s; a body or too large a header; no WebSocket or
     *  another protocol; too large a message; answers that are not read. Clients that close or are silent do not
     *  count. */
    uint64_t refused = 0;
    /** Frames that were replaced by newer frames of their stream, counted for each client. The client was too slow, or
     *  samples came faster than they could be encoded. */
    uint64_t dropped = 0;
};

/** Serves one TCP port for the page, for the data that pages show (protocol `insonify.view.v1`) and for Foxglove.
 *
 *  A separate thread does all work; every function is thread-safe and waits for no client. If data are published faster
 *  than they are sent, the oldest are dropped; see SendQueue. A client that does not speak WebSocket, or sends a
 *  message of more than 64 KiB, is disconnected; before the handshake it receives 400, 413 or 431. At the max number of
 *  connections, connections without a request are closed first.
 *
 *  Without a token, only this server's own pages may connect as pages, under a numeric address or as localhost. As
 *  Foxglove clients, programs and Foxglove's own pages may connect too; the latter may only read. Other web sites are
 *  refused. */
class Server {
public:
    /** Throws ListenError if the port cannot be opened. `handler` must outlive this. */
    Server(ServerOptions options, ServerHandler& handler);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    uint16_t port() const;   ///< The requested port, or a free port.
    uint64_t pages() const;  ///< Number of connected pages.
    uint64_t subscribers(uint32_t channel) const;
    uint64_t foxglove() const;          ///< Number of Foxglove clients.
    uint64_t parameterReaders() const;  ///< Number of clients subscribed to parameters.
    void toPages(uint32_t stream, Frame frame);
    void toFoxglove(uint32_t channel, uint64_t nanoseconds, Bytes message);
    /** Sends a message that must arrive. It is replaced only by a newer message of this function, not of
     *  toFoxglove(). */
    void everyToFoxglove(uint32_t channel, uint64_t nanoseconds, Bytes message);
    void timeToFoxglove(uint64_t nanoseconds);
    /** Sends changes to the clients that have subscribed to them. */
    void parametersToFoxglove(Parameters changed);
    void reply(uint64_t client, std::string text);
    ServerCounts counts() const;
    /** See types::ThrottledWarning::consumeWarning(). */
    std::string consumeWarning();

    class Core;

private:
    std::unique_ptr<Core> core_;
};

}  // namespace insonify::viewer
