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

inline constexpr const char* page_protocol = "insonify.view.v1";

struct PageFile {
    std::string_view type, content;  ///< MIME type, text.
};
/** A file of the page, all of which are in the program; "/" is the page itself. */
std::optional<PageFile> pageFile(std::string_view path);

/** What a server asks of who owns it; called on the server's thread. */
class ServerHandler {
public:
    virtual ~ServerHandler() = default;
    virtual std::optional<PageFile> file(std::string_view path) = 0;
    /** What a page gets first. */
    virtual std::vector<Frame> greeting() = 0;
    /** A page has sent this; the answer is given to Server::reply(). */
    virtual void request(uint64_t client, std::string text) = 0;
    /** A Foxglove client asks for parameters, or to set some, which only who `may_set` may. */
    virtual void parameters(uint64_t client, ParameterRequest request, bool may_set) = 0;
    /** A Foxglove client has subscribed to these channels, and has seen nothing of them yet. */
    virtual void subscribed(const std::vector<uint32_t>& channels) = 0;
    /** One has subscribed to parameters, and has been told of none yet. */
    virtual void subscribedToParameters() = 0;
};

struct ServerOptions {
    std::string address = "127.0.0.1";
    uint16_t port = 0;
    std::string token;         ///< Empty: none is asked for.
    size_t clients = 16;       ///< Pages and Foxglove clients together [1].
    double idle_timeout = 30;  ///< [s]
    std::vector<FoxgloveChannel> channels;
    std::string session;  ///< See serverInfo().
};

/** No connection can come. */
struct ListenError : std::runtime_error {
    ListenError(const char* culprit, const std::string& what) : std::runtime_error(what), property(culprit) {}
    const char* property;  ///< What is to be changed: "port" or "address".
};

struct ServerCounts {
    uint64_t clients = 0;  ///< Connected now.
    /** Connections, since the start, that were turned away or closed for what they did: too many; a wrong token, origin
     *  or host; no HTTP, no whole request within 5 s, a body or too large a header; no or another WebSocket, a message
     *  that is too large, answers that are not read. Not those that close, or that are only silent. */
    uint64_t refused = 0;
    /** Frames, for each client who would have had them, that a newer one of their stream took the place of: because the
     *  client was too slow, or samples came faster than they could be made messages of. */
    uint64_t dropped = 0;
};

/** One TCP port for the page, for the data that pages show (protocol `insonify.view.v1`) and for Foxglove.
 *
 *  A thread of its own does all; every function is for any thread and waits for no client. What is published faster
 *  than it is sent is dropped, the oldest first; see SendQueue. A client that sends what is not WebSocket, or a message
 *  of more than 64 KiB, is closed, and before it is one answered with 400, 413 or 431. When too many are connected,
 *  those that have asked for nothing yet make room. Without a token only pages from this server itself may connect as
 *  pages, under a numeric address or as localhost, and as Foxglove clients besides those only Foxglove's own, which may
 *  only read, and programs: no other web site can. */
class Server {
public:
    /** Throws ListenError where the port cannot be had. `handler` outlives this. */
    Server(ServerOptions options, ServerHandler& handler);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    uint16_t port() const;   ///< That was asked for, or was free.
    uint64_t pages() const;  ///< That are connected.
    uint64_t subscribers(uint32_t channel) const;
    uint64_t foxglove() const;          ///< Clients that are Foxglove's.
    uint64_t parameterReaders() const;  ///< Those that are told of parameters.
    void toPages(uint32_t stream, Frame frame);
    void toFoxglove(uint32_t channel, uint64_t nanoseconds, Bytes message);
    /** The same for what must arrive: only a newer one of these takes its place, and toFoxglove() does not. */
    void everyToFoxglove(uint32_t channel, uint64_t nanoseconds, Bytes message);
    void timeToFoxglove(uint64_t nanoseconds);
    /** To those who have asked to be told of them. */
    void parametersToFoxglove(Parameters changed);
    void reply(uint64_t client, std::string text);
    ServerCounts counts() const;
    /** See types::ThrottledWarning::takeWarning(). */
    std::string takeWarning();

    class Core;

private:
    std::unique_ptr<Core> core_;
};

}  // namespace insonify::viewer
