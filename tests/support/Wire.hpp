#pragma once
// A driver's end of a connection or of a serial line, as a file descriptor.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <stdexcept>

#include "components/device/wire/Bytes.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::device {

/** An open file that a driver communicates with. */
class Wire {
public:
    static int connected(int port) {
        const int file = socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(static_cast<uint16_t>(port));
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(connect(file, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
        return file;
    }
    static int line(const std::filesystem::path& link) {
        const int file = open(link.c_str(), O_RDWR | O_NOCTTY);
        termios raw{};
        cfmakeraw(&raw);
        tcsetattr(file, TCSANOW, &raw);
        return file;
    }

    explicit Wire(int file) : file_(file) {}
    ~Wire() { close(file_); }
    Wire(const Wire&) = delete;
    Wire& operator=(const Wire&) = delete;

    void say(const Bytes& bytes) const { EXPECT_EQ(::write(file_, bytes.data(), bytes.size()), ssize_t(bytes.size())); }
    /** Returns the next bytes; throws if none arrive. */
    Bytes receive() const {
        pollfd ready{file_, POLLIN, 0};
        Bytes bytes(4096);
        const auto patience = static_cast<int>(std::chrono::milliseconds(test::patience).count());
        const ssize_t got = poll(&ready, 1, patience) == 1 ? ::read(file_, bytes.data(), bytes.size()) : -1;
        if (got <= 0) throw std::runtime_error("time out");
        bytes.resize(static_cast<size_t>(got));
        return bytes;
    }

private:
    int file_;
};

}  // namespace insonify::device
