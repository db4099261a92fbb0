#pragma once
// One connection of a server. Only for Server.cpp, because it takes long to compile.
#include <atomic>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>

#include "components/viewer/Frame.hpp"
#include "components/viewer/Server.hpp"
#include "types/text/Notice.hpp"

namespace insonify::viewer {

/** Data shared by all connections of a server. */
struct ServerContext {
    ServerContext(ServerOptions asked, ServerHandler& answers)
        : options(std::move(asked)), handler(answers), access{options.token} {}
    virtual ~ServerContext() = default;
    virtual void leave(uint64_t session) = 0;
    virtual void recount() = 0;  ///< Counts clients and subscriptions again.

    const ServerOptions options;
    ServerHandler& handler;
    const AccessPolicy access;
    types::ThrottledWarning refused{"connection", "refused"};
    std::atomic<uint64_t> clients{0}, dropped{0};
};

/** Queues frames for one client, which may be slow or not read at all. Keeps only the newest frame of each stream and
 *  counts the replaced frames. Not thread-safe. */
class SendQueue {
public:
    static constexpr size_t max_replies = 64;
    /** Stream of the time, beyond all streams of 32 bits. A replaced frame of it is not counted. */
    static constexpr uint64_t time_stream = uint64_t{1} << 32;

    /** Queues a frame of a stream, replacing an older frame that still waits. */
    void put(uint64_t stream, Frame frame) {
        for (auto& [key, waiting] : streams_)
            if (key == stream) {
                if (stream != time_stream) ++dropped_;
                waiting = std::move(frame);
                return;
            }
        streams_.emplace_back(stream, std::move(frame));
    }
    /** Queues a frame that must arrive, before the frames of streams. With `of` it replaces an older posted frame of
     *  that stream that still waits. Returns false if too many wait: the client must be disconnected. */
    bool post(Frame frame, std::optional<uint64_t> of = {}) {
        for (auto& [key, waiting] : replies_)
            if (of && key == of) {
                waiting = std::move(frame);
                return true;
            }
        if (replies_.size() == max_replies) return false;
        replies_.emplace_back(of, std::move(frame));
        return true;
    }
    /** Returns the next frame to send: replies first, then the stream that has waited longest. */
    std::optional<Frame> next() {
        if (!replies_.empty()) {
            Frame frame = std::move(replies_.front().second);
            replies_.pop_front();
            return frame;
        }
        if (streams_.empty()) return std::nullopt;
        Frame frame = std::move(streams_.front().second);
        streams_.pop_front();
        return frame;
    }
    void forget(uint64_t stream) {
        const auto is_of_it = [stream](const auto& waiting) { return waiting.first == stream; };
        std::erase_if(replies_, is_of_it);
        std::erase_if(streams_, is_of_it);
    }
    uint64_t dropped() const { return dropped_; }  ///< Frames [1].

private:
    std::deque<std::pair<std::optional<uint64_t>, Frame>> replies_;
    std::deque<std::pair<uint64_t, Frame>> streams_;
    uint64_t dropped_ = 0;
};

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using HttpRequest = http::request<http::string_body>;
using HttpResponse = http::response<http::string_body>;
using Error = boost::system::error_code;

constexpr size_t max_message = 64 << 10;  // from a client [B]
constexpr size_t max_header = 8 << 10;    // of a request [B]
constexpr size_t max_rest = 256 << 10;    // of a refused request, read so that the answer arrives [B]
constexpr auto request_timeout = std::chrono::seconds(5), response_timeout = std::chrono::seconds(10),
               rest_timeout = std::chrono::seconds(1);

inline std::string toText(beast::string_view view) { return {view.data(), view.size()}; }

inline AccessPolicy::Request admission(const HttpRequest& request) {
    return {toText(request.target()), toText(request[http::field::host]), toText(request[http::field::origin]),
            toText(request[http::field::authorization])};
}

inline HttpResponse responseTo(const HttpRequest& request, unsigned status, std::string_view type,
                               std::string_view body) {
    HttpResponse response(http::int_to_status(status), request.version());
    response.set(http::field::content_type, beast::string_view(type.data(), type.size()));
    response.set(http::field::cache_control, "no-cache");
    response.set(http::field::x_frame_options, "DENY");
    response.set("Referrer-Policy", "no-referrer");  // the address may contain a token
    response.keep_alive(false);
    response.body() = body;
    response.prepare_payload();
    if (request.method() == http::verb::head) response.body().clear();
    return response;
}

/** Returns the client's first offered protocol that this server speaks; empty if none. */
inline std::string getProtocol(const std::string& offered) {
    const std::string separators = ", \t";
    for (size_t at = 0; (at = offered.find_first_not_of(separators, at)) != std::string::npos;) {
        const size_t end = std::min(offered.find_first_of(separators, at), offered.size());
        const std::string name = offered.substr(at, end - at);
        for (const char* const known : {foxglove_sdk_protocol, foxglove_protocol, page_protocol})
            if (name == known) return name;
        at = end;
    }
    return "";
}

enum class Kind { None, Page, Foxglove };
/** One connection: a request, which is answered or becomes a WebSocket. */
class Session : public std::enable_shared_from_this<Session> {
public:
    Session(tcp::socket socket, ServerContext& context, uint64_t id);
    Kind kind() const { return open_ ? kind_ : Kind::None; }
    bool isAdmitted() const { return admitted_; }  ///< Counts as a client; the handshake may be under way.
    bool hasAsked() const { return asked_; }       ///< Its request has arrived.
    const Subscriptions& subscriptions() const { return subscriptions_; }
    const ParameterSubscriptions& parameters() const { return parameters_; }
    void readRequest();
    void put(uint64_t stream, Frame frame);
    void post(Frame frame, std::optional<uint64_t> of = {});
    void close();
    /** Closes this session, and nothing else, if `work` throws. */
    void attempt(auto&& work);

private:
    beast::tcp_stream& stream() { return ws_.next_layer(); }
    /** Returns a completion handler for Asio. */
    auto handler(auto work) {
        return [self = shared_from_this(), work](const Error& error, size_t = 0) {
            self->attempt([&] { work(*self, error); });
        };
    }
    void answer();
    void answerError(const Error& error);
    void refuse(const AccessPolicy::Refusal& refusal);
    void respond(HttpResponse response);
    void readRest();
    void upgrade();
    void countError(const Error& error);
    void greet();
    void readMessage();
    void taken(std::string text);
    void handleFoxglove(const std::string& text);
    bool handleParameters(const std::string& text);
    void send();
    void leave();

    ServerContext& context_;
    const uint64_t id_;
    websocket::stream<beast::tcp_stream> ws_;
    beast::flat_buffer buffer_{max_message + max_header};
    std::optional<http::request_parser<http::string_body>> parser_;
    std::optional<HttpResponse> response_;
    Subscriptions subscriptions_;
    ParameterSubscriptions parameters_;
    std::string protocol_;  ///< The agreed protocol.
    bool may_set_ = false;  ///< Whether it may set parameters.
    Kind kind_ = Kind::None;
    SendQueue queue_;
    Frame sending_;
    uint64_t reported_dropped_ = 0;
    size_t rest_ = 0;  ///< Bytes read after the answer [B].
    bool asked_ = false, admitted_ = false, open_ = false, writing_ = false;
};

inline Session::Session(tcp::socket socket, ServerContext& context, uint64_t id)
    : context_(context), id_(id), ws_(std::move(socket)), subscriptions_(context.options.channels.size()) {
    Error ignored;
    stream().socket().set_option(tcp::no_delay(true), ignored);
}

void Session::attempt(auto&& work) try { work(); } catch (const std::exception& thrown) {
    context_.refused.add(std::string("an error in this server: ") + thrown.what());
    leave();
}

inline void Session::readRequest() {
    parser_.emplace();
    parser_->header_limit(max_header);
    parser_->body_limit(0);
    stream().expires_after(request_timeout);
    http::async_read(stream(), buffer_, *parser_, handler([](Session& self, const Error& error) {
                         error ? self.answerError(error) : self.answer();
                     }));
}

/** Answers a request that cannot be read. */
inline void Session::answerError(const Error& error) {
    asked_ = true;
    if (error == beast::error::timeout) context_.refused.add("no complete request came within 5 s");
    const bool is_gone = error == http::error::end_of_stream || error == http::error::partial_message;
    if (is_gone || error.category() != http::make_error_code(http::error::end_of_stream).category()) return leave();
    const bool header = error == http::error::header_limit || error == http::error::buffer_overflow;
    refuse({error == http::error::body_limit ? 413u : header ? 431u : 400u, "the request: " + error.message()});
}

/** Missing files and wrong methods do not count as refused connections. */
inline void Session::refuse(const AccessPolicy::Refusal& refusal) {
    if (refusal.status != 404 && refusal.status != 405)
        context_.refused.add(std::to_string(refusal.status) + ", " + refusal.reason);
    respond(responseTo(parser_->get(), refusal.status, "text/plain", refusal.reason + "\n"));
}

inline void Session::answer() {
    asked_ = true;
    const HttpRequest& request = parser_->get();
    const AccessPolicy::Request asked = admission(request);
    const bool wants_socket = websocket::is_upgrade(request);
    protocol_ = getProtocol(toText(request[http::field::sec_websocket_protocol]));
    const bool foxglove = protocol_ == foxglove_protocol || protocol_ == foxglove_sdk_protocol;
    kind_ = foxglove ? Kind::Foxglove : protocol_ == page_protocol ? Kind::Page : Kind::None;
    may_set_ = context_.access.maySet(asked);
    const std::string path = asked.target.substr(0, asked.target.find('?'));
    using enum AccessPolicy::Use;
    const AccessPolicy::Use use = !wants_socket ? (path == "/" ? Page : File) : foxglove ? Read : Control;
    if (const auto refusal = context_.access.decide(asked, use)) return refuse(*refusal);
    if (wants_socket) {
        if (kind_ == Kind::None)
            return refuse({400, std::string("the subprotocol must be ") + foxglove_sdk_protocol + ", " +
                                    foxglove_protocol + " or " + page_protocol});
        if (context_.clients >= context_.options.clients)
            return refuse({503, "the max number of clients is connected"});
        return upgrade();
    }
    if (request.method() != http::verb::get && request.method() != http::verb::head)
        return refuse({405, "only GET and HEAD are served"});
    const auto file = context_.handler.file(path);
    if (!file) return refuse({404, "there is no such file"});
    respond(responseTo(request, 200, file->type, file->content));
}

inline void Session::respond(HttpResponse response) {
    response_.emplace(std::move(response));
    stream().expires_after(response_timeout);
    http::async_write(stream(), *response_, handler([](Session& self, const Error& error) {
                          if (error) return self.leave();
                          Error ignored;
                          self.stream().socket().shutdown(tcp::socket::shutdown_send, ignored);
                          self.stream().expires_after(rest_timeout);
                          self.readRest();
                      }));
}

/** Reads until the client closes: closing with unread bytes would discard the answer. */
inline void Session::readRest() {
    buffer_.clear();
    stream().async_read_some(buffer_.prepare(max_header), [self = shared_from_this()](const Error& error, size_t size) {
        self->rest_ += size;
        error || self->rest_ > max_rest ? self->leave() : self->readRest();
    });
}

inline void Session::upgrade() {
    admitted_ = true;
    context_.recount();
    stream().expires_never();
    const auto idle = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::duration<double>(context_.options.idle_timeout));
    ws_.set_option(websocket::stream_base::timeout{request_timeout, idle, true});
    ws_.set_option(websocket::stream_base::decorator([protocol = protocol_](websocket::response_type& response) {
        response.set(http::field::sec_websocket_protocol, protocol);
    }));
    ws_.read_message_max(max_message);
    ws_.auto_fragment(false);
    ws_.async_accept(parser_->get(), handler([](Session& self, const Error& error) {
                         if (!error) return self.greet();
                         self.countError(error);
                         self.leave();
                     }));
}

/** Counts a client that does not speak WebSocket, or sends too much; not a client that is gone. */
inline void Session::countError(const Error& error) {
    const bool is_error = error.category() == websocket::make_error_code(websocket::error::closed).category();
    if (is_error && error != websocket::error::closed) context_.refused.add("WebSocket: " + error.message());
}

inline void Session::greet() {
    open_ = true;
    buffer_.consume(buffer_.size());
    context_.recount();
    if (kind_ == Kind::Foxglove) {
        post({"", toBytes(serverInfo(context_.options.session)), true});
        post({"", toBytes(advertise(context_.options.channels)), true});
    } else {
        for (Frame& frame : context_.handler.greeting()) post(std::move(frame));
    }
    readMessage();
}

inline void Session::readMessage() {
    ws_.async_read(buffer_, handler([](Session& self, const Error& error) {
                       if (error) {
                           self.countError(error);
                           return self.leave();
                       }
                       self.taken(beast::buffers_to_string(self.buffer_.data()));
                       self.buffer_.consume(self.buffer_.size());
                       self.readMessage();
                   }));
}

inline void Session::taken(std::string text) {
    if (kind_ == Kind::Page) return context_.handler.request(id_, std::move(text));
    if (ws_.got_text() && !handleParameters(text)) handleFoxglove(text);
}

/** Returns false if the message is not about parameters. */
inline bool Session::handleParameters(const std::string& text) try {
    using enum ParameterRequest::Kind;
    ParameterRequest request = readParameterRequest(text);
    if (request.kind == Other) return false;
    if (request.kind == Get || request.kind == Set) {
        context_.handler.parameters(id_, std::move(request), may_set_);
        return true;
    }
    parameters_.take(request);
    context_.recount();
    if (request.kind == Subscribe) context_.handler.subscribedToParameters();
    return true;
} catch (const std::invalid_argument& error) {
    post({"", toBytes(diagnosticText(std::string("the message ") + error.what())), true});
    return true;
}

inline void Session::handleFoxglove(const std::string& text) {
    const auto before = subscriptions_.all();
    if (const std::string diagnostic = subscriptions_.take(text); !diagnostic.empty())
        post({"", toBytes(diagnosticText("the message " + diagnostic)), true});
    for (const auto& [subscription, channel] : before)
        if (!subscriptions_.all().contains(subscription)) queue_.forget(subscription);
    context_.recount();
    std::vector<uint32_t> channels;
    for (const auto& one : subscriptions_.all())
        if (!before.contains(one.first)) channels.push_back(one.second);
    if (!channels.empty()) context_.handler.subscribed(channels);
}

inline void Session::put(uint64_t stream, Frame frame) {
    queue_.put(stream, std::move(frame));
    context_.dropped += queue_.dropped() - std::exchange(reported_dropped_, queue_.dropped());
    send();
}

inline void Session::post(Frame frame, std::optional<uint64_t> of) {
    if (queue_.post(std::move(frame), of)) return send();
    context_.refused.add("answers are not read");
    close();
}

inline void Session::send() {
    if (writing_ || !open_) return;
    auto next = queue_.next();
    if (!next) return;
    sending_ = std::move(*next);
    writing_ = true;
    ws_.text(sending_.text);
    const std::array<asio::const_buffer, 2> buffers{asio::buffer(sending_.head), asio::buffer(*sending_.body)};
    ws_.async_write(buffers, handler([](Session& self, const Error& error) {
                        self.writing_ = false;
                        self.sending_ = {};
                        error ? self.leave() : self.send();
                    }));
}

inline void Session::close() {
    open_ = false;
    Error ignored;
    stream().socket().close(ignored);
}

inline void Session::leave() {
    close();
    context_.leave(id_);
}

}  // namespace insonify::viewer
