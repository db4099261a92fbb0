#pragma once
// A device of the ping protocol with a simulated clock, its clients, and a sonar that answers.
#include <gmock/gmock.h>

#include <map>

#include "components/device/ping/PingDevice.hpp"

namespace insonify::device {

inline types::Time seconds(double s) { return types::Time::fromSeconds(1e9 + s); }

/** Returns a sonar's ping for a request: one beam, code k in bin k unless given otherwise. */
inline std::shared_ptr<types::Sonar> pingFor(const types::SonarSettings& request, float speed_of_sound = 1500) {
    auto ping = std::make_shared<types::Sonar>();
    ping->time = request.time;
    ping->speed_of_sound = speed_of_sound;
    ping->bin_count = request.bin_count;
    ping->beam_count = 1;
    ping->bearings = {request.bearing};
    ping->setBins(request.range / request.bin_count, static_cast<double>(speed_of_sound));
    ping->bins.resize(request.bin_count);
    for (size_t k = 0; k < ping->bins.size(); ++k) ping->bins[k] = static_cast<float>(k * 257);
    return ping;
}

class PingBench {
public:
    explicit PingBench(PingDevice& device) : device_(device) {}

    types::Time now() const { return now_; }
    /** Sends a message as a client. */
    void say(const auto& message, PingClient client = 1, uint8_t destination = 0) {
        give(pingBytes(message, 0, destination), client, false);
    }
    void give(const Bytes& bytes, PingClient client = 1, bool datagram = true) {
        device_.receive(client, bytes, datagram, now_);
    }
    void wait(double s) {
        now_ = now_ + types::Time::fromSeconds(s);
        device_.tick(now_);
    }
    /** Advances time until the device has due work, at most by the given time; returns the advanced time [s]. */
    double waitForNext(double at_most = 10) {
        const auto next = device_.wakeAt();
        const double s = next ? std::min(at_most, (*next - now_).seconds()) : at_most;
        wait(std::max(0.0, s));
        return s;
    }
    std::optional<types::SonarSettings> request() { return device_.consumeRequest(); }
    void answer(const types::SonarSettings& request, float speed_of_sound = 1500) {
        device_.setPing(pingFor(request, speed_of_sound), now_);
    }
    /** Returns the bytes sent to a client since the last call. */
    std::vector<PingFrame> received(PingClient client = 1) {
        for (const PingOutgoing& out : device_.consumeOutgoing())
            for (PingFrame& frame : pingFrames(out.bytes, 4096)) inbox_[out.client].push_back(std::move(frame));
        return std::exchange(inbox_[client], {});
    }
    /** Returns the only message sent to a client. */
    template <class Message>
    Message only(PingClient client = 1) {
        const auto frames = received(client);
        EXPECT_EQ(frames.size(), 1u) << Message::message;
        if (frames.size() != 1) return {};
        EXPECT_EQ(frames[0].message, Message::message);
        const auto message = pingMessage<Message>(frames[0]);
        EXPECT_TRUE(message.has_value());
        return message.value_or(Message{});
    }
    template <class Message>
    std::string getRefusal(const Message& message) {
        say(message);
        const PingNack nack = only<PingNack>();
        EXPECT_EQ(nack.nacked, Message::message);
        return nack.text;
    }

private:
    PingDevice& device_;
    types::Time now_ = seconds(0);
    std::map<PingClient, std::vector<PingFrame>> inbox_;
};

}  // namespace insonify::device
