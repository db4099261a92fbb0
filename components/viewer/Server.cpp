#include "components/viewer/Server.hpp"

#include <arpa/inet.h>
#include <fcntl.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <map>
#include <mutex>
#include <thread>

#include "components/viewer/Session.hpp"
#include "types/Thread.hpp"

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

constexpr size_t spare_connections = 32;  // for file requests, in addition to clients [1]
/** Keys of Foxglove's streams in the map of waiting frames: channels, beyond all streams of pages; then the time. */
constexpr uint64_t foxglove_keys = uint64_t{1} << 32, time_key = uint64_t{1} << 33;

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
    const size_t end = host.starts_with('[') ? std::min(host.find(']'), host.size() - 1) + 1 : host.find(':');
    const std::string name(host.substr(0, end));
    if (end < host.size()) {
        const std::string_view digits = host.substr(end + 1);
        uint16_t port = 0;
        const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
        if (host[end] != ':' || error != std::errc() || rest != digits.data() + digits.size()) return false;
    }
    in6_addr any{};
    if (name.starts_with('[') && name.ends_with(']'))
        return inet_pton(AF_INET6, name.substr(1, name.size() - 2).c_str(), &any) == 1;
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

/** The server's thread, and the data that it shares with others. */
class Server::Core final : public ServerContext {
public:
    struct Waiting {
        Frame frame;
        uint64_t nanoseconds;
    };

    Core(ServerOptions asked, ServerHandler& answers)
        : ServerContext(std::move(asked), answers), subscribers_(options.channels.size()) {
        listen();
        accept();
        thread_ = types::startThread("the server of the live view", [this] { serve(); });
    }
    ~Core() override;

    void serve();
    void listen();
    void accept();
    void take(tcp::socket socket);
    bool makeRoom();
    /** Runs `work` on the server's thread. */
    template <class Work>
    void post(Work&& work) {
        asio::post(io_, std::forward<Work>(work));
    }
    void publish(uint64_t key, Frame frame, uint64_t nanoseconds);
    void deliver();
    static void give(Session& session, uint64_t key, const Waiting& item);
    /** Runs on the server's thread. */
    void forEachFoxglove(auto&& work) {
        const auto sessions = sessions_;  // sending may end a session
        for (const auto& [id, session] : sessions)
            if (session->kind() == Kind::Foxglove) session->attempt([&] { work(*session); });
    }
    void leave(uint64_t session) override;
    void recount() override;

    asio::io_context io_{1};
    tcp::acceptor acceptor_{io_};
    asio::steady_timer retry_{io_};
    std::map<uint64_t, std::shared_ptr<Session>> sessions_;
    uint64_t next_session_ = 1;
    uint16_t port_ = 0;
    std::atomic<uint64_t> pages_{0}, foxglove_{0}, parameter_readers_{0};
    std::vector<std::atomic<uint64_t>> subscribers_;  ///< By channel.
    std::mutex mutex_;
    std::map<uint64_t, Waiting> waiting_;  ///< Published but not yet delivered, the newest of each stream.
    std::thread thread_;
};

/** Runs the server. An error outside a session ends neither a session nor the program. */
void Server::Core::serve() {
    for (bool done = false; !done;) try {
            io_.run();
            done = true;
        } catch (const std::exception& error) {
            refused.add(std::string("an error in this server: ") + error.what());
        }
}

Server::Core::~Core() {
    post([this] {
        acceptor_.close();
        retry_.cancel();
        for (const auto& [id, session] : std::exchange(sessions_, {})) session->close();
        io_.stop();
    });
    thread_.join();
}

namespace {

/** Prevents child processes from inheriting a connection. */
void keepFromChildren(int descriptor) { fcntl(descriptor, F_SETFD, FD_CLOEXEC); }

}  // namespace

void Server::Core::listen() try {
    const tcp::endpoint endpoint(asio::ip::make_address(options.address), options.port);
    acceptor_.open(endpoint.protocol());
    keepFromChildren(acceptor_.native_handle());
    acceptor_.set_option(tcp::acceptor::reuse_address(true));
    acceptor_.bind(endpoint);
    acceptor_.listen();
    port_ = acceptor_.local_endpoint().port();
} catch (const boost::system::system_error& error) {
    if (error.code() == asio::error::address_in_use || error.code() == asio::error::access_denied)
        throw ListenError("port", "is " + std::to_string(options.port) + ", which cannot be opened on " +
                                      options.address + ": " + error.code().message() +
                                      "; use another, or 0 for any free port");
    throw ListenError("address", "is " + options.address + ", on which nothing can listen: " + error.code().message() +
                                     "; it must be an address of this machine, such as 127.0.0.1 or 0.0.0.0");
}

void Server::Core::accept() {
    acceptor_.async_accept([this](const Error& error, tcp::socket socket) {
        if (!acceptor_.is_open()) return;
        if (!error) {
            accept();
            return take(std::move(socket));
        }
        retry_.expires_after(std::chrono::milliseconds(50));  // out of descriptors, for example
        retry_.async_wait([this](const Error& cancelled) {
            if (!cancelled) accept();
        });
    });
}

void Server::Core::take(tcp::socket socket) {
    if (sessions_.size() >= options.clients + spare_connections && !makeRoom())
        return refused.add("too many connections");
    keepFromChildren(socket.native_handle());
    const uint64_t id = next_session_++;
    const auto session = std::make_shared<Session>(std::move(socket), *this, id);
    sessions_[id] = session;
    session->readRequest();
}

/** Ends the oldest connection without a request, or else the oldest that is not a client. */
bool Server::Core::makeRoom() {
    auto oldest = std::ranges::find_if(sessions_, [](const auto& one) { return !one.second->hasAsked(); });
    if (oldest == sessions_.end())
        oldest = std::ranges::find_if(sessions_, [](const auto& one) { return one.second->kind() == Kind::None; });
    if (oldest == sessions_.end()) return false;
    refused.add("too many connections: the oldest without a request, or that does not read its answer, was closed");
    oldest->second->close();
    sessions_.erase(oldest);
    recount();
    return true;
}

void Server::Core::publish(uint64_t key, Frame frame, uint64_t nanoseconds) {
    std::lock_guard lock(mutex_);
    const bool idle = waiting_.empty();
    if (waiting_.contains(key) && key != time_key)
        dropped += key < foxglove_keys ? pages_ : subscribers_[key - foxglove_keys];
    waiting_[key] = {std::move(frame), nanoseconds};
    if (idle) post([this] { deliver(); });
}

void Server::Core::deliver() {
    std::map<uint64_t, Waiting> published;
    {
        std::lock_guard lock(mutex_);
        published.swap(waiting_);
    }
    const auto sessions = sessions_;  // sending may end a session
    for (const auto& [key, item] : published)
        for (const auto& [id, session] : sessions) session->attempt([&] { give(*session, key, item); });
}

void Server::Core::give(Session& session, uint64_t key, const Waiting& item) {
    if (key < foxglove_keys && session.kind() == Kind::Page) session.put(static_cast<uint32_t>(key), item.frame);
    if (key < foxglove_keys || session.kind() != Kind::Foxglove) return;
    if (key == time_key) return session.put(SendQueue::time_stream, item.frame);
    for (const auto& [subscription, channel] : session.subscriptions().all())
        if (channel == key - foxglove_keys)
            session.put(subscription, {messageHead(subscription, item.nanoseconds), item.frame.body, false});
}

void Server::Core::leave(uint64_t session) {
    if (sessions_.erase(session) > 0) recount();
}

void Server::Core::recount() {
    uint64_t admitted = 0, pages = 0, others = 0, readers = 0;
    std::vector<uint64_t> wanted(subscribers_.size());
    for (const auto& [id, session] : sessions_) {
        admitted += session->isAdmitted() ? 1 : 0;
        pages += session->kind() == Kind::Page ? 1 : 0;
        others += session->kind() == Kind::Foxglove ? 1 : 0;
        readers += session->parameters().any() ? 1 : 0;
        for (const auto& [subscription, channel] : session->subscriptions().all()) ++wanted[channel];
    }
    clients = admitted;
    pages_ = pages;
    foxglove_ = others;
    parameter_readers_ = readers;
    for (size_t i = 0; i < wanted.size(); ++i) subscribers_[i] = wanted[i];
}

Server::Server(ServerOptions options, ServerHandler& handler)
    : core_(std::make_unique<Core>(std::move(options), handler)) {}
Server::~Server() = default;
uint16_t Server::port() const { return core_->port_; }
uint64_t Server::pages() const { return core_->pages_; }
uint64_t Server::subscribers(uint32_t channel) const { return core_->subscribers_[channel]; }
void Server::toPages(uint32_t stream, Frame frame) { core_->publish(stream, std::move(frame), 0); }
void Server::toFoxglove(uint32_t channel, uint64_t nanoseconds, Bytes message) {
    core_->publish(foxglove_keys + channel, {"", std::move(message), false}, nanoseconds);
}
uint64_t Server::foxglove() const { return core_->foxglove_; }
uint64_t Server::parameterReaders() const { return core_->parameter_readers_; }
void Server::timeToFoxglove(uint64_t nanoseconds) {
    core_->publish(time_key, {"", toBytes(timeMessage(nanoseconds)), false}, nanoseconds);
}
void Server::everyToFoxglove(uint32_t channel, uint64_t nanoseconds, Bytes message) {
    core_->post([core = core_.get(), channel, nanoseconds, message = std::move(message)] {
        core->forEachFoxglove([&](Session& session) {
            for (const auto& [subscription, subscribed] : session.subscriptions().all())
                if (subscribed == channel)
                    session.post({messageHead(subscription, nanoseconds), message, false}, subscription);
        });
    });
}
void Server::parametersToFoxglove(Parameters changed) {
    core_->post([core = core_.get(), changed = std::move(changed)] {
        core->forEachFoxglove([&](Session& session) {
            Parameters wanted;
            for (const auto& one : changed)
                if (session.parameters().contains(one.first)) wanted.push_back(one);
            if (!wanted.empty()) session.post({"", toBytes(parameterValues(wanted, {})), true});
        });
    });
}
void Server::reply(uint64_t client, std::string text) {
    core_->post([core = core_.get(), client, frame = Frame{"", toBytes(std::move(text)), true}] {
        const auto found = core->sessions_.find(client);
        if (found == core->sessions_.end()) return;
        const auto session = found->second;  // sending may end it
        session->attempt([&] { session->post(frame); });
    });
}
ServerCounts Server::counts() const { return {core_->clients, core_->refused.count(), core_->dropped}; }
std::string Server::consumeWarning() { return core_->refused.consumeWarning(); }

}  // namespace insonify::viewer
