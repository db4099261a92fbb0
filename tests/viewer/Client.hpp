#pragma once
// HTTP and WebSocket over a plain socket, so that invalid bytes can be sent too.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "tests/support/Waiting.hpp"

namespace insonify::viewer {

/** Returns a free port that is not assigned by chance: it is below those that the system assigns. */
inline uint16_t quietPort() {
    std::random_device random;
    while (true) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<uint16_t>(10'000 + random() % 20'000));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const int tried = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        const bool is_free = bind(tried, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
        close(tried);
        if (is_free) return ntohs(address.sin_port);
    }
}

class Client {
public:
    explicit Client(uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        const timeval patience{test::patience.count(), 0};
        setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        connected_ = connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    }
    ~Client() { close(socket_); }
    Client(Client&& other) noexcept
        : socket_(std::exchange(other.socket_, -1)),
          connected_(other.connected_),
          received_(std::move(other.received_)) {}

    bool connected() const { return connected_; }
    bool send(const std::string& bytes) {
        return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
    }
    /** Requests `target`; returns everything received until the connection is closed. */
    std::string get(const std::string& target, const std::string& more = "") {
        send("GET " + target + " HTTP/1.1\r\nHost: localhost\r\n" + more + "\r\n");
        return rest();
    }
    /** Returns everything received until the connection is closed. */
    std::string rest() {
        while (receive()) {
        }
        return std::move(received_);
    }
    /** Becomes a WebSocket; returns the first line of the answer. */
    std::string upgrade(const std::string& protocol, const std::string& target = "/", const std::string& more = "") {
        sendUpgrade(protocol, target, more);
        return upgraded();
    }
    void sendUpgrade(const std::string& protocol, const std::string& target = "/", const std::string& more = "") {
        send("GET " + target + " HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" +
             "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: " +
             protocol + "\r\n" + more + "\r\n");
    }
    /** Returns the first line of the answer to sendUpgrade(). */
    std::string upgraded() {
        while (received_.find("\r\n\r\n") == std::string::npos)
            if (!receive()) break;
        const size_t end = received_.find("\r\n\r\n");
        head_ = received_.substr(0, end);
        received_.erase(0, end == std::string::npos ? end : end + 4);
        return head_.substr(0, head_.find("\r\n"));
    }
    const std::string& head() const { return head_; }  ///< Headers of the answer to sendUpgrade().
    /** Sends a text message of less than 64 KiB. */
    void say(const std::string& text) {
        std::string frame = "\x81";
        if (text.size() < 126)
            frame += static_cast<char>(0x80 | text.size());
        else
            frame += {static_cast<char>(0xfe), static_cast<char>(text.size() >> 8), static_cast<char>(text.size())};
        frame += std::string(4, '\0');  // a mask that changes nothing
        send(frame + text);
    }
    /** Returns the payload of the next message; none if the connection was closed or a close frame arrived. */
    std::optional<std::string> nextMessage() {
        while (true) {
            if (!fill(2)) return std::nullopt;
            const auto byte = [&](size_t i) { return static_cast<unsigned char>(received_[i]); };
            const unsigned code = byte(0) & 15;
            size_t size = byte(1) & 127, head = 2;
            const size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
            if (!fill(2 + more)) return std::nullopt;
            if (more > 0) size = 0;
            for (size_t i = 0; i < more; ++i) size = size << 8 | byte(head++);
            if (code == 8) close_code_ = fill(head + 2) && size >= 2 ? byte(head) << 8 | byte(head + 1) : 1005;
            if (code == 8 || !fill(head + size)) return std::nullopt;
            const std::string payload = received_.substr(head, size);
            received_.erase(0, head + size);
            if (code == 1 || code == 2) return payload;
        }
    }
    std::string textOfNext() { return nextMessage().value_or("nothing"); }
    int closeCode() const { return close_code_; }  ///< 0: no close frame arrived.

private:
    bool receive() {
        char bytes[65536];
        ssize_t got = 0;
        do got = recv(socket_, bytes, sizeof bytes, 0);
        while (got < 0 && errno == EINTR);  // this process was stopped
        if (got > 0) received_.append(bytes, static_cast<size_t>(got));
        return got > 0;
    }
    bool fill(size_t size) {
        while (received_.size() < size)
            if (!receive()) return false;
        return true;
    }

    int socket_;
    bool connected_ = false;
    int close_code_ = 0;
    std::string received_, head_;
};

}  // namespace insonify::viewer
