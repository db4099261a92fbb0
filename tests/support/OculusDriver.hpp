#pragma once
// The behaviour of published drivers of the Oculus on the wire, and their checks.
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

#include "components/device/oculus/OculusMessages.hpp"
#include "tests/support/Waiting.hpp"

namespace insonify::test {

using device::OculusFire;
using device::OculusHeader;
using device::OculusId;
using device::OculusResult;
using device::OculusStatus;

/** A socket that is closed with its owner. */
class Socket {
public:
    explicit Socket(int type) : file_(socket(AF_INET, type, 0)) {}
    ~Socket() { close(file_); }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;
    int file() const { return file_; }
    static sockaddr_in address(uint32_t ip, uint16_t port) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(port);
        to.sin_addr.s_addr = ip;
        return to;
    }
    /** Throws if nothing arrives within patience. */
    void awaitBytes() const {
        pollfd ready{file_, POLLIN, 0};
        const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(patience).count();
        if (poll(&ready, 1, static_cast<int>(wait)) != 1) throw std::runtime_error("the device has fallen silent");
    }

private:
    int file_;
};

/** Listens for the status of devices on a UDP port, like both published listeners: by the size of packets. */
class OculusListener {
public:
    /** @param port 0: any free port */
    explicit OculusListener(uint16_t port = 0) {
        const int on = 1;
        setsockopt(socket_.file(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        sockaddr_in here = Socket::address(INADDR_ANY, port);
        if (bind(socket_.file(), reinterpret_cast<sockaddr*>(&here), sizeof here) != 0)
            throw std::runtime_error("the port of the status is taken");
    }
    uint16_t port() const {
        sockaddr_in here{};
        socklen_t size = sizeof here;
        getsockname(socket_.file(), reinterpret_cast<sockaddr*>(&here), &size);
        return ntohs(here.sin_port);
    }
    OculusStatus next() const {
        for (;;) {
            device::Bytes bytes(2000);
            socket_.awaitBytes();
            const ssize_t size = recv(socket_.file(), bytes.data(), bytes.size(), 0);
            if (size != 142) continue;
            bytes.resize(142);
            if (const auto status = device::oculusStatus(bytes)) return *status;
        }
    }

private:
    const Socket socket_{SOCK_DGRAM};
};

/** A connection to a device, read as by drivers: a header, then the number of bytes in the header. Drivers do not
 *  search for the next header: invalid messages throw std::runtime_error. */
class OculusDriver {
public:
    OculusDriver(uint32_t ip, uint16_t port) {
        sockaddr_in to = Socket::address(ip, port);
        if (connect(socket_.file(), reinterpret_cast<sockaddr*>(&to), sizeof to) != 0)
            throw std::runtime_error("nobody listens");
    }
    explicit OculusDriver(uint16_t port) : OculusDriver(htonl(INADDR_LOOPBACK), port) {}
    virtual ~OculusDriver() = default;

    void send(const device::Bytes& bytes) const {
        if (::send(socket_.file(), bytes.data(), bytes.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(bytes.size()))
            throw std::runtime_error("the device takes no more");
    }
    device::Bytes nextMessage() {
        device::Bytes message = take(OculusHeader::size);
        const auto header = device::oculusHeader(message);
        if (!header || !accepts(*header)) throw std::runtime_error("received bytes are no message of the device");
        const device::Bytes payload = take(header->payload_size);
        message.insert(message.end(), payload.begin(), payload.end());
        return message;
    }
    /** Returns the next ping, and skips dummies and other messages. */
    OculusResult nextPing() {
        for (;;) {
            const device::Bytes message = nextMessage();
            if (!device::oculusHeader(message)->is(OculusId::PingResult)) continue;
            std::string reason;
            const auto ping = device::oculusResult(message, &reason);
            if (!ping) throw std::runtime_error("a ping " + reason);
            if (ping->message_size != message.size())
                throw std::runtime_error("a ping whose size differs from the size in its header");
            return *ping;
        }
    }

protected:
    virtual bool accepts(const OculusHeader&) const { return true; }

private:
    device::Bytes take(size_t size) const {
        device::Bytes bytes(size);
        for (size_t at = 0; at < size;) {
            socket_.awaitBytes();
            const ssize_t got = recv(socket_.file(), bytes.data() + at, size - at, 0);
            if (got <= 0) throw std::runtime_error("the device has closed the connection");
            at += static_cast<size_t>(got);
        }
        return bytes;
    }

    const Socket socket_{SOCK_STREAM};
};

/** A driver like oculus_driver of ENSTA Bretagne. It finds the device by its status alone, ignores other sources, and
 *  sends settings again until a ping echoes them, or in standby until a dummy arrives. */
class EnstaDriver : public OculusDriver {
public:
    EnstaDriver(const OculusStatus& status, uint16_t port)
        : OculusDriver(getIp(status), port), source_(status.header.source) {}

    /** Returns the number of times that the request was sent; 100: without success. */
    int request(OculusFire fire) {
        fire.flags |= OculusFire::row_gains;
        for (int sent = 1; sent < 100; ++sent) {
            send(device::toBytes(fire));
            const device::Bytes message = nextMessage();
            if (fire.isStandby() ? device::oculusHeader(message)->is(OculusId::Dummy) : echoes(fire, message))
                return sent;
        }
        return 100;
    }
    /** Returns the amplitude of a bin after the driver has removed the gains. */
    static double amplitude(const OculusResult& ping, size_t bin, size_t beam) {
        const size_t row = bin * ping.rowBytes();
        const auto gain = device::read<uint32_t>(ping.image, row);
        const size_t at = row + 4 + beam * ping.codeBytes();
        const double code = ping.codeBytes() == 2 ? device::read<uint16_t>(ping.image, at) : ping.image[at];
        return code / std::sqrt(gain);
    }

private:
    static uint32_t getIp(const OculusStatus& status) { return std::bit_cast<uint32_t>(status.address); }
    static bool echoes(const OculusFire& asked, const device::Bytes& message) {
        const auto ping = device::oculusResult(message);
        if (!ping) return false;
        const OculusFire& reported = ping->fire;
        const double gain = reported.mode == 2 ? (reported.gain_percent - 40) * 100 / 60 : reported.gain_percent;
        return reported.mode == asked.mode && reported.gamma == asked.gamma && reported.flags == asked.flags &&
               reported.range == asked.range && std::abs(gain - asked.gain_percent) < 0.1;
    }
    bool accepts(const OculusHeader& header) const override { return header.source == source_; }

    const uint16_t source_;
};

/** A driver like Rock's drivers/sonar_oculus_m750d: 53 bytes with payload size 0 and version 0, codes of 8 bits without
 *  gains, and a buffer that no message may exceed. */
class RockDriver : public OculusDriver {
public:
    static constexpr size_t buffer_size = 800'000;
    using OculusDriver::OculusDriver;

    void fire(OculusFire fire) const {
        fire.header.version = 0;
        fire.flags = OculusFire::range_in_metres | OculusFire::simple_result;
        device::Bytes bytes = device::toBytes(fire);
        device::write<uint32_t>(bytes, 10, 0);
        send(bytes);
    }

private:
    bool accepts(const OculusHeader& header) const override { return header.payload_size <= buffer_size; }
};

/** A driver like liboculus of the University of Washington: version 2, 32 bits; it gives up when the status reports
 *  that the device boots. */
struct UwDriver : OculusDriver {
    UwDriver(const OculusStatus& status, uint16_t port) : OculusDriver(port) {
        if ((status.status & 7) < 2) throw std::runtime_error("the device boots");
    }
    void fire(OculusFire fire) const {
        fire.header.version = 2;
        fire.flags |= OculusFire::beams_512;
        fire.extended_flags = OculusFire::wide_32;
        send(device::toBytes(fire));
    }
};

}  // namespace insonify::test
