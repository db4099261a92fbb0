#include "components/device/wire/Network.hpp"

#include <fcntl.h>
#include <netinet/tcp.h>
#include <pty.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio.hpp>
#include <cerrno>
#include <cstring>
#include <deque>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "types/Thread.hpp"

namespace insonify::device {
namespace asio = boost::asio;
using boost::system::error_code;
using Tcp = asio::ip::tcp;
using Udp = asio::ip::udp;

namespace {

std::string toText(const auto& endpoint) {
    return endpoint.address().to_string() + ":" + std::to_string(endpoint.port());
}

asio::ip::address parseAddress(const std::string& address) {
    error_code error;
    const asio::ip::address parsed = asio::ip::make_address(address, error);
    if (error) throw NetworkError("address", "is " + address + ", which is no address; write one as 127.0.0.1 or ::1");
    return parsed;
}

template <class Protocol>
typename Protocol::endpoint makeEndpoint(const std::string& address, uint16_t port) {
    return {parseAddress(address), port};
}

/** Opens and binds; errors begin with `what` before the port. */
template <class Socket, class Endpoint>
void bindTo(Socket& socket, const Endpoint& endpoint) {
    error_code error;
    socket.open(endpoint.protocol(), error);
    if constexpr (std::is_same_v<Endpoint, Tcp::endpoint>)  // not UDP: two processes could share a port
        if (!error) socket.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) socket.bind(endpoint, error);
    if (error) throw NetworkError("port", "is " + toText(endpoint) + ", where it cannot listen: " + error.message());
    fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
}

/** Ends a connection after half a minute without contact. */
void keepAlive(int socket) {
    const auto set = [&](int level, int option, int value) { setsockopt(socket, level, option, &value, sizeof value); };
    set(IPPROTO_TCP, TCP_KEEPIDLE, 10);  // [s]
    set(IPPROTO_TCP, TCP_KEEPINTVL, 5);  // [s]
    set(IPPROTO_TCP, TCP_KEEPCNT, 3);
    set(SOL_SOCKET, SO_KEEPALIVE, 1);
}

}  // namespace

/** Its events and counters may be used on any thread, the rest on the network's. */
class Network::Core {
public:
    explicit Core(std::function<void()> wake)
        : wake_(std::move(wake)), thread_(types::startThread("the network of a device", [this] { run(); })) {}
    ~Core() {
        asio::post(io, [this] { shut(); });
        thread_.join();
    }

    /** The operations of an end, on the network's thread. */
    class EndBase {
    public:
        virtual ~EndBase() = default;
        virtual void send(uint64_t client, Bytes bytes, Kind kind) = 0;
        virtual void close(uint64_t client) = 0;
        virtual void resume() {}
        virtual void shut() = 0;
        uint16_t port = 0;
        std::string name;
    };

    /** False: too much waits, stop reading for now. */
    bool report(NetworkEvent event) {
        bool room = false;
        {
            std::lock_guard lock(mutex_);
            received_ += sizeof event + event.bytes.size();
            room = received_ < max_received;
            events_.push_back(std::move(event));
        }
        wake_();
        return room;
    }
    bool hasRoom() {
        std::lock_guard lock(mutex_);
        return received_ < max_received;
    }
    std::vector<NetworkEvent> take() {
        std::vector<NetworkEvent> taken;
        bool was_full = false;
        {
            std::lock_guard lock(mutex_);
            taken.swap(events_);
            was_full = std::exchange(received_, 0) >= max_received;
        }
        if (was_full)
            asio::post(io, [this] {
                for (const auto& end : ends) end->resume();
            });
        return taken;
    }
    /** Runs `work` on the network's thread, and waits until it ends. */
    template <class Work>
    void call(Work&& work) {
        std::packaged_task<void()> task(std::forward<Work>(work));
        auto done = task.get_future();
        asio::post(io, std::ref(task));
        done.get();
    }
    template <class Made, class... Arguments>
    End add(Arguments&&... arguments) {
        call(
            [&] { ends.push_back(std::make_shared<Made>(*this, ends.size(), std::forward<Arguments>(arguments)...)); });
        return ends.size() - 1;
    }
    void wakeAt(std::chrono::steady_clock::time_point when) {
        asio::post(io, [this, when] {
            timer_.expires_at(when);
            timer_.async_wait([this](error_code error) {
                if (!error) wake_();
            });
        });
    }
    void sendTo(const Udp::endpoint& to, const Bytes& bytes) {
        Udp::socket& socket = to.protocol() == Udp::v4() ? v4_ : v6_;
        error_code ignored;
        if (!socket.is_open()) {
            socket.open(to.protocol(), ignored);
            socket.set_option(asio::socket_base::broadcast(true), ignored);
            socket.set_option(asio::ip::multicast::enable_loopback(true), ignored);
            socket.non_blocking(true, ignored);
        }
        error_code error;
        socket.send_to(asio::buffer(bytes), to, 0, error);
        if (error) ++dropped;
    }

    asio::io_context io{1};
    std::vector<std::shared_ptr<EndBase>> ends;
    std::atomic<uint64_t> dropped{0}, displaced{0}, failures{0};
    uint64_t last_message = 0;  ///< Messages from connections so far, for the network's thread.

private:
    /** Serves until the end. A failure in one place, such as out of memory, is counted, and the other ends continue. */
    void run() {
        while (true) try {
                io.run();
                return;
            } catch (const std::exception&) {
                ++failures;
                asio::post(io, [this] {
                    for (const auto& end : ends) end->resume();
                });
            }
    }
    void shut() {
        for (const auto& end : ends) end->shut();
        timer_.cancel();
        work_.reset();
    }

    std::function<void()> wake_;
    std::mutex mutex_;
    std::vector<NetworkEvent> events_;
    size_t received_ = 0;  ///< In `events_` [bytes].
    asio::executor_work_guard<asio::io_context::executor_type> work_{io.get_executor()};
    asio::steady_timer timer_{io};
    Udp::socket v4_{io}, v6_{io};
    std::thread thread_;
};

namespace {

/** A stream of bytes to and from one client: a connection, or a serial line. */
template <class Stream>
class Session : public std::enable_shared_from_this<Session<Stream>> {
public:
    /** For a stream that ends when too much waits: called once, at its end. */
    struct Ended : std::function<void()> {};
    /** For a stream that cannot end and drops its oldest bytes: empties the stream's own buffer. */
    struct Drain : std::function<void()> {};

    Session(Network::Core& core, Stream stream, Client client, Ended ended)
        : core_(core), stream_(std::move(stream)), client_(client), ended_(std::move(ended)) {}
    Session(Network::Core& core, Stream stream, Client client, Drain drain)
        : core_(core), stream_(std::move(stream)), client_(client), drain_(std::move(drain)) {}

    void read() {
        if (reading_ || closed_) return;
        reading_ = true;
        stream_.async_read_some(asio::buffer(buffer_),
                                [self = this->shared_from_this()](error_code error, size_t count) {
                                    self->reading_ = false;
                                    if (self->closed_) return;
                                    if (error) return self->end();
                                    self->last_message_ = ++self->core_.last_message;
                                    const auto begin = self->buffer_.begin();
                                    const Bytes bytes(begin, begin + static_cast<std::ptrdiff_t>(count));
                                    if (self->core_.report({NetworkEvent::Kind::Received, self->client_, bytes, ""}))
                                        self->read();
                                });
    }
    void send(Bytes bytes, Network::Kind kind) {
        if (closed_ || closing_) return;
        if (kind == Network::Kind::Stream) {
            if (newest_) ++core_.dropped;
            newest_ = std::move(bytes);
        } else {
            if (ended_ && waiting_ + bytes.size() > Network::max_replies) return end();
            if (drain_ && waiting_ + bytes.size() > Network::max_line) forgetFor(bytes.size());
            waiting_ += bytes.size();
            replies_.push_back(std::move(bytes));
        }
        write();
    }
    void close() {
        closing_ = true;
        write();
    }
    /** The number of its last message among those of all sessions; 0: it has sent none. */
    uint64_t last_message() const { return last_message_; }
    /** Ends it at once and drops its waiting messages. */
    void end() {
        if (closed_ || !ended_) return;
        shut();
        ended_();
        core_.report({NetworkEvent::Kind::Closed, client_, {}, ""});
    }
    /** Without an event. */
    void shut() {
        closed_ = true;
        error_code ignored;
        stream_.close(ignored);
    }

private:
    void write() {
        if (writing_ || closed_) return;
        if (!replies_.empty()) {
            sending_ = std::move(replies_.front());
            replies_.pop_front();
            waiting_ -= sending_.size();
        } else if (newest_) {
            sending_ = *std::exchange(newest_, {});
        } else {
            if (closing_) end();
            return;
        }
        writing_ = true;
        asio::async_write(stream_, asio::buffer(sending_), [self = this->shared_from_this()](error_code error, size_t) {
            self->writing_ = false;
            if (self->closed_) return;
            if (error) return self->end();
            self->write();
        });
    }
    /** Drops the oldest, until the given number of bytes fits. */
    void forgetFor(size_t count) {
        drain_();
        while (!replies_.empty() && waiting_ + count > Network::max_line) {
            waiting_ -= replies_.front().size();
            replies_.pop_front();
            ++core_.dropped;
        }
    }

    Network::Core& core_;
    Stream stream_;
    Client client_;
    Ended ended_;
    Drain drain_;
    std::array<uint8_t, 65536> buffer_{};
    std::deque<Bytes> replies_;
    std::optional<Bytes> newest_;  ///< Newest of the streamed messages.
    Bytes sending_;
    size_t waiting_ = 0;  ///< In `replies_` [bytes].
    uint64_t last_message_ = 0;
    bool reading_ = false, writing_ = false, closing_ = false, closed_ = false;
};

/** Connections. */
class TcpEnd final : public Network::Core::EndBase {
public:
    TcpEnd(Network::Core& core, End end, const Tcp::endpoint& at) : core_(core), end_(end), acceptor_(core.io) {
        bindTo(acceptor_, at);
        error_code error;
        acceptor_.listen(asio::socket_base::max_listen_connections, error);
        if (error) throw NetworkError("port", "is " + toText(at) + ", where it cannot listen: " + error.message());
        port = acceptor_.local_endpoint().port();
        name = "TCP " + toText(acceptor_.local_endpoint());
        accept();
    }
    void send(uint64_t client, Bytes bytes, Network::Kind kind) override {
        if (const auto session = find(client)) session->send(std::move(bytes), kind);
    }
    void close(uint64_t client) override {
        if (const auto session = find(client)) session->close();
    }
    void resume() override {
        for (const auto& [number, session] : sessions_) session->read();
        accept();
    }
    void shut() override {
        error_code ignored;
        acceptor_.close(ignored);
        retry_.cancel();
        for (const auto& [number, session] : std::exchange(sessions_, {})) session->shut();
    }

private:
    using TcpSession = Session<Tcp::socket>;

    std::shared_ptr<TcpSession> find(uint64_t client) const {
        const auto found = sessions_.find(client);
        return found == sessions_.end() ? nullptr : found->second;
    }
    /** Waits for the next client, unless it waits already or too much waits for the task. */
    void accept() {
        if (accepting_ || !core_.hasRoom()) return;
        accepting_ = true;
        acceptor_.async_accept([this](error_code error, Tcp::socket socket) {
            if (!acceptor_.is_open()) return;
            accepting_ = false;
            if (!error) open(std::move(socket));
            if (!error) return accept();
            accepting_ = true;
            retry_.expires_after(std::chrono::milliseconds(100));  // for example when the process has no more files
            retry_.async_wait([this](error_code cancelled) {
                accepting_ = false;
                if (!cancelled) accept();
            });
        });
    }
    void open(Tcp::socket socket) {
        error_code error;
        const Tcp::endpoint peer = socket.remote_endpoint(error);
        if (error) return;
        if (sessions_.size() >= Network::max_clients) displace();
        socket.set_option(Tcp::no_delay(true), error);
        keepAlive(socket.native_handle());
        fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
        const uint64_t number = next_++;
        const auto session =
            std::make_shared<TcpSession>(core_, std::move(socket), Client{end_, number},
                                         TcpSession::Ended{[this, number] { sessions_.erase(number); }});
        sessions_[number] = session;
        core_.report({NetworkEvent::Kind::Opened, {end_, number}, {}, toText(peer)});
        session->read();
    }

    /** Disconnects the client silent for longest, for a newer client. */
    void displace() {
        const auto silent = std::ranges::min_element(sessions_, {}, [](const auto& each) {
                                return each.second->last_message();
                            })->second;
        ++core_.displaced;
        silent->end();
    }

    Network::Core& core_;
    End end_;
    Tcp::acceptor acceptor_;
    asio::steady_timer retry_{core_.io};
    bool accepting_ = false;
    std::map<uint64_t, std::shared_ptr<TcpSession>> sessions_;
    uint64_t next_ = 1;
};

/** Datagrams; a client is a sender's address. */
class UdpEnd final : public Network::Core::EndBase {
public:
    UdpEnd(Network::Core& core, End end, const Udp::endpoint& at) : core_(core), end_(end), socket_(core.io) {
        bindTo(socket_, at);
        socket_.non_blocking(true);
        port = socket_.local_endpoint().port();
        name = "UDP " + toText(socket_.local_endpoint());
        read();
    }
    void send(uint64_t client, Bytes bytes, Network::Kind /*kind*/) override {
        const auto found = clients_.find(client);
        if (found == clients_.end()) return;
        error_code error;
        socket_.send_to(asio::buffer(bytes), found->second.endpoint, 0, error);
        if (error) ++core_.dropped;
    }
    void close(uint64_t client) override {
        if (clients_.erase(client) > 0) core_.report({NetworkEvent::Kind::Closed, {end_, client}, {}, ""});
    }
    void resume() override { read(); }
    void shut() override {
        error_code ignored;
        socket_.close(ignored);
    }

private:
    struct Known {
        Udp::endpoint endpoint;
        uint64_t last_message = 0;  ///< The number of its last datagram, among those of all.
    };

    void read() {
        if (std::exchange(reading_, true)) return;
        socket_.async_receive_from(asio::buffer(buffer_), from_, [this](error_code error, size_t count) {
            if (!socket_.is_open() || error == asio::error::operation_aborted) return;
            reading_ = false;
            if (!error) take(count);
            read();
        });
    }
    void take(size_t count) {
        if (!core_.hasRoom()) {
            ++core_.dropped;
            return;
        }
        const Client client{end_, getNumber(from_)};
        const auto begin = buffer_.begin();
        core_.report({NetworkEvent::Kind::Received, client, {begin, begin + static_cast<std::ptrdiff_t>(count)}, ""});
    }
    uint64_t getNumber(const Udp::endpoint& peer) {
        for (auto& [number, known] : clients_)
            if (known.endpoint == peer) {
                known.last_message = ++last_message_;
                return number;
            }
        if (clients_.size() >= Network::max_clients)
            close(std::ranges::min_element(clients_, {}, [](const auto& each) {
                      return each.second.last_message;
                  })->first);
        clients_[next_] = {peer, ++last_message_};
        core_.report({NetworkEvent::Kind::Opened, {end_, next_}, {}, toText(peer)});
        return next_++;
    }

    Network::Core& core_;
    End end_;
    Udp::socket socket_;
    Udp::endpoint from_;
    std::array<uint8_t, 65536> buffer_{};
    std::map<uint64_t, Known> clients_;
    uint64_t next_ = 1, last_message_ = 0;
    bool reading_ = false;
};

/** The two sides of a pseudo terminal, raw; drivers open `slave`. */
struct Terminal {
    int master = -1, slave = -1;
    std::string name;
};

Terminal openTerminal() {
    Terminal made;
    termios raw{};
    cfmakeraw(&raw);
    std::array<char, 256> name{};
    if (openpty(&made.master, &made.slave, name.data(), &raw, nullptr) != 0)
        throw NetworkError("serial", std::string("cannot be opened: ") + std::strerror(errno));
    for (const int side : {made.master, made.slave}) fcntl(side, F_SETFD, FD_CLOEXEC);
    fcntl(made.slave, F_SETFL, O_NONBLOCK);
    made.name = name.data();
    return made;
}

/** Whether a path is a link to a pseudo terminal, as a line that ended without removing its link leaves. */
bool leadsToTerminal(const std::filesystem::path& link) {
    std::error_code none;
    return std::filesystem::read_symlink(link, none).string().starts_with("/dev/pts/");
}

/** A single permanent client, since a line does not show who is at its other side. An open slave side keeps the line up
 *  while no driver has opened it. */
class SerialEnd final : public Network::Core::EndBase {
public:
    SerialEnd(Network::Core& core, End end, std::filesystem::path link)
        : client_{end, 1}, link_(std::move(link)), terminal_(openTerminal()) {
        std::error_code error;
        if (leadsToTerminal(link_)) std::filesystem::remove(link_, error);
        std::filesystem::create_symlink(terminal_.name, link_, error);
        if (error) {
            shut();
            ::close(terminal_.master);
            throw NetworkError("serial", "is " + link_.string() + ", which cannot be made: " + error.message());
        }
        name = "serial line " + link_.string();
        session_ = std::make_shared<Line>(core, asio::posix::stream_descriptor(core.io, terminal_.master), client_,
                                          Line::Drain{[this] { drain(); }});
        core.report({NetworkEvent::Kind::Opened, client_, {}, terminal_.name});
        session_->read();
    }
    void send(uint64_t /*client*/, Bytes bytes, Network::Kind kind) override { session_->send(std::move(bytes), kind); }
    void close(uint64_t /*client*/) override {}
    void resume() override { session_->read(); }
    void shut() override {
        if (session_) session_->shut();
        if (const int slave = std::exchange(terminal_.slave, -1); slave >= 0) ::close(slave);
        std::error_code ignored;
        if (std::filesystem::read_symlink(link_, ignored) == terminal_.name) std::filesystem::remove(link_, ignored);
    }

private:
    using Line = Session<asio::posix::stream_descriptor>;

    /** Reads instead of flushing: a flush leaves the bytes that have not reached the slave side yet, and does not
     *  request them. */
    void drain() const {
        std::array<uint8_t, 4096> past{};
        while (::read(terminal_.slave, past.data(), past.size()) > 0) {
        }
    }

    Client client_;
    std::filesystem::path link_;
    Terminal terminal_;
    std::shared_ptr<Line> session_;
};

}  // namespace

void checkAddress(types::Diagnostics& diagnostics, const std::string& address) {
    try {
        parseAddress(address);
    } catch (const NetworkError& error) {
        diagnostics.push_back({error.property, error.what()});
    }
}

Network::Network(std::function<void()> wake) : core_(std::make_unique<Core>(std::move(wake))) {}
Network::~Network() = default;

End Network::listenTcp(const std::string& address, uint16_t port) {
    return core_->add<TcpEnd>(makeEndpoint<Tcp>(address, port));
}

End Network::listenUdp(const std::string& address, uint16_t port) {
    return core_->add<UdpEnd>(makeEndpoint<Udp>(address, port));
}

End Network::openSerial(const std::filesystem::path& link) { return core_->add<SerialEnd>(link); }

uint16_t Network::getPort(End end) const { return core_->ends[end]->port; }

std::vector<std::string> Network::names() const {
    std::vector<std::string> all;
    for (const auto& end : core_->ends) all.push_back(end->name);
    return all;
}

std::vector<NetworkEvent> Network::take() { return core_->take(); }

void Network::send(Client client, Bytes bytes, Kind kind) {
    asio::post(core_->io, [core = core_.get(), client, kind, sent = std::move(bytes)]() mutable {
        core->ends[client.end]->send(client.number, std::move(sent), kind);
    });
}

void Network::sendTo(const std::string& address, uint16_t port, Bytes bytes) {
    asio::post(core_->io, [core = core_.get(), to = makeEndpoint<Udp>(address, port), sent = std::move(bytes)] {
        core->sendTo(to, sent);
    });
}

void Network::close(Client client) {
    asio::post(core_->io, [core = core_.get(), client] { core->ends[client.end]->close(client.number); });
}

void Network::wakeAt(std::chrono::steady_clock::time_point when) { core_->wakeAt(when); }

uint64_t Network::dropped() const { return core_->dropped; }
uint64_t Network::displaced() const { return core_->displaced; }
uint64_t Network::failures() const { return core_->failures; }

}  // namespace insonify::device
