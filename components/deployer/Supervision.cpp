#include "components/deployer/Supervision.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <system_error>

#include "types/Thread.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::deployer {
namespace {

using namespace std::chrono_literals;

constexpr size_t max_clients = 16;  ///< Beyond, the oldest connection is closed.
constexpr auto patience = 2s;       ///< For the request of a client, and for its reading of the answer.

/** Returns the interval in which systemd expects WATCHDOG=1; none: it does not. */
std::optional<std::chrono::microseconds> watchdogInterval() {
    const char *interval = std::getenv("WATCHDOG_USEC"), *process = std::getenv("WATCHDOG_PID");
    const long long us = interval ? std::strtoll(interval, nullptr, 10) : 0;
    const bool is_other = process && std::to_string(getpid()) != process;
    return us > 0 && !is_other ? std::optional(std::chrono::microseconds(us)) : std::nullopt;
}

[[noreturn]] void refuse(const std::string& where, const std::string& what, int error) {
    throw types::ConfigError("", "--health",
                             fmt::format("is {}, {}: {}", where, what, std::generic_category().message(error)));
}

/** Parses "[ADDRESS:]PORT"; none: it is the name of a file. */
std::optional<sockaddr_in> portIn(const std::string& where) {
    const size_t colon = where.rfind(':');
    const std::string host = colon == where.npos ? "127.0.0.1" : where.substr(0, colon);
    const std::string digits = where.substr(colon == where.npos ? 0 : colon + 1);
    const bool is_number = !digits.empty() && digits.find_first_not_of("0123456789") == digits.npos;
    if (!is_number || where.find('/') != where.npos) return std::nullopt;
    uint16_t port = 0;
    const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    if (error != std::errc() || port == 0 || inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1)
        throw types::ConfigError("", "--health",
                                 fmt::format("is {}; may be a file, or [ADDRESS:]PORT with a numeric address and a "
                                             "port of 1 to {}",
                                             where, UINT16_MAX));
    return address;
}

const char* getName(bool is_healthy) { return is_healthy ? "200 OK" : "503 Service Unavailable"; }

}  // namespace

bool notifyManager(const std::string& message) {
    const char* const name = std::getenv("NOTIFY_SOCKET");
    sockaddr_un address{};
    const size_t length = name ? std::strlen(name) : 0;
    if (length < 2 || length >= sizeof address.sun_path || (name[0] != '/' && name[0] != '@')) return false;
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, name, length);
    if (name[0] == '@') address.sun_path[0] = '\0';
    const int file = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (file < 0) return false;
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length);
    const ssize_t sent = sendto(file, message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
                                reinterpret_cast<const sockaddr*>(&address), size);
    close(file);
    return sent == static_cast<ssize_t>(message.size());
}

Supervision::Supervision(const std::string& where) : beat_(watchdogInterval()) {
    if (!where.empty()) listenOn(where);
    notifyManager("STATUS=loading the deployment");
    writeFile();
}

void Supervision::listenOn(const std::string& where) {
    const auto address = portIn(where);
    if (!address) {
        file_ = std::filesystem::absolute(where);
        // Each report replaces the file, and would replace a device or a link.
        const std::filesystem::file_status state = std::filesystem::symlink_status(file_);
        if (std::filesystem::exists(state) && !std::filesystem::is_regular_file(state))
            throw types::ConfigError("", "--health",
                                     fmt::format("is {}, which cannot be written: it is no regular file", where));
        std::ofstream draft(file_.string() + ".part");
        if (!draft) refuse(where, "which cannot be written", errno);
        return;
    }
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const int on = 1;
    setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (listener_ < 0 || bind(listener_, reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0 ||
        listen(listener_, static_cast<int>(max_clients)) != 0) {
        const int error = errno;
        if (listener_ >= 0) close(listener_);
        refuse(where, "where no requests can be taken", error);
    }
}

Supervision::~Supervision() {
    ending_ = true;
    if (thread_.joinable()) thread_.join();
    if (state_ != State::Stopping) notifyManager("STOPPING=1");
    state_ = State::Stopping;
    writeFile();
    for (const Client& client : clients_) close(client.socket);
    if (listener_ >= 0) close(listener_);
}

void Supervision::watch(const framework::Deployment& deployment, const std::atomic<bool>& stop) {
    deployment_ = &deployment;
    stop_ = &stop;
    if (std::getenv("NOTIFY_SOCKET") || listener_ >= 0 || !file_.empty())
        thread_ = types::startThread("the supervision", [this] { loop(); });
}

void Supervision::loop() {
    while (!ending_) {
        look();
        waitForClients(is_ready_ ? 100ms : 10ms);
    }
}

Supervision::State Supervision::stateNow() const {
    if (*stop_ || ending_) return State::Stopping;
    for (const auto& task : deployment_->tasks()) {
        if (!task->isRunning()) return is_ready_ ? State::Stopping : State::Starting;
        const double own = task->activity().settings().watchdog;
        const double limit = own > 0 ? own : deployment_->spec().watchdog;
        const int64_t since = task->timing().workingSince().count();
        if (since != 0 && static_cast<double>(framework::Timing::ticks() - since) * 1e-9 > limit) return State::Hanging;
    }
    return State::Running;
}

void Supervision::look() {
    const State now = stateNow(), before = std::exchange(state_, now);
    if (now == State::Stopping && before != now) notifyManager("STOPPING=1");
    if (now == State::Running && !std::exchange(is_ready_, true)) notifyManager("READY=1");
    if (now == State::Running && beat_ && Clock::now() >= next_beat_) {
        next_beat_ = Clock::now() + *beat_ / 4;
        notifyManager("WATCHDOG=1");
    }
    if (now == before && Clock::now() < next_report_) return;
    next_report_ = Clock::now() + 1s;
    writeFile();
    const Json all = report();
    std::string status = all["state"].get<std::string>();
    for (const auto& [task, error] : all["errors"].items()) status += "; " + task + ": " + error.get<std::string>();
    if (status != std::exchange(status_, status)) notifyManager("STATUS=" + status);
}

Json Supervision::report() const {
    constexpr const char* names[] = {"starting", "running", "hanging", "stopping"};
    Json errors = Json::object(), pings = Json::object();
    if (deployment_)
        for (const auto& task : deployment_->tasks()) {
            if (task->state() == framework::TaskState::RunTimeError) errors[task->name()] = task->lastError();
            for (const auto* port : task->outputs())
                if (port->counted()) pings[port->path()] = port->written();
        }
    return {{"healthy", state_ == State::Running},
            {"state", names[static_cast<size_t>(state_)]},
            {"pings", pings},
            {"errors", errors},
            {"process", getpid()},
            {"time", std::time(nullptr)}};
}

void Supervision::writeFile() const {
    if (file_.empty()) return;
    const std::filesystem::path draft = file_.string() + ".part";
    std::ofstream stream(draft);
    stream << report().dump() << '\n';
    stream.close();
    std::error_code failed;  // of a full disk: the old file shows by its time that it is old
    if (stream) std::filesystem::rename(draft, file_, failed);
}

void Supervision::waitForClients(std::chrono::milliseconds at_most) {
    std::vector<pollfd> waiting = {{listener_, POLLIN, 0}};
    for (const Client& client : clients_) waiting.push_back({client.socket, POLLIN, 0});
    if (poll(waiting.data(), waiting.size(), static_cast<int>(at_most.count())) < 0) return;
    for (size_t i = 0; i < clients_.size(); ++i)
        if (waiting[i + 1].revents != 0) serve(clients_[i]);
    for (Client& client : clients_)
        if (client.socket >= 0 && Clock::now() > client.since + patience) close(std::exchange(client.socket, -1));
    std::erase_if(clients_, [](const Client& client) { return client.socket < 0; });
    if ((waiting.front().revents & POLLIN) == 0) return;
    const int socket = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (socket < 0) return;
    if (clients_.size() == max_clients) close(clients_.front().socket), clients_.erase(clients_.begin());
    clients_.push_back({socket, Clock::now()});
}

/** Answers any request, whatever it asks for, once its first bytes are there; what follows is read and ignored. */
void Supervision::serve(Client& client) const {
    char request[4096];
    const ssize_t got = recv(client.socket, request, sizeof request, 0);
    if (got <= 0) return void(close(std::exchange(client.socket, -1)));
    if (std::exchange(client.is_answered, true)) return;
    const std::string body = report().dump() + "\n";
    const std::string answer = fmt::format(
        "HTTP/1.1 {}\r\nContent-Type: application/json\r\nContent-Length: {}\r\nCache-Control: no-store\r\n"
        "Connection: close\r\n\r\n{}",
        getName(state_ == State::Running), body.size(), body);
    send(client.socket, answer.data(), answer.size(), MSG_NOSIGNAL);
    shutdown(client.socket, SHUT_WR);
}

}  // namespace insonify::deployer
