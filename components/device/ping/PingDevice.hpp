#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/device/RequestedPings.hpp"
#include "components/device/ping/PingProtocol.hpp"
#include "types/Time.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarSettings.hpp"

namespace insonify::device {

/** A connected client, by a number from the owner of the connections. */
using PingClient = uint64_t;

/** Bytes to send to a client. */
struct PingOutgoing {
    PingClient client = 0;
    Bytes bytes;
    bool stream = false;  ///< True: of a stream, only the newest matters; false: an answer.
};

/** A value that a client sets, and the device's bounds. */
struct PingBound {
    const char* name;
    uint32_t value, min, max;
};

/** Returns a diagnostic of the first value out of bounds: "angle is 400; must be 0 to 399"; empty: none. */
std::string findDiagnostic(std::initializer_list<PingBound> bounds);

/** Converts a ping's codes to 8 bits. @param max_code the max code of the receiver */
Bytes bytesOfCodes(std::span<const float> codes, double max_code);

/** One ping at a time that is requested from a simulated sonar. All times are steady.
 *
 *  Devices count echoes by time. The range follows from the sonar's speed of sound, which its pings contain. If a ping
 *  has another speed of sound than the request assumed, the ping is requested again. */
class PingTurn {
public:
    /** Requests a ping that listens for `listens` [s] and is answered no sooner than `after` from now [s]. @param
     *  wanted all settings except time and range */
    void ask(types::SonarSettings wanted, double listens, double after, types::Time now);
    /** Takes a ping that answers the request; false for other pings. @param stamp the steady time of the ping's */
    bool take(const types::SonarPtr& ping, types::Time stamp, types::Time now);
    /** Requests a ping again that has not arrived, after the clock was set back. */
    void repeat(types::Time now) {
        if (!requests_.empty()) ask(now);
    }
    void drop() {
        requests_.clear();
        ping_.reset();
    }

    bool underWay() const { return ping_ || !requests_.empty(); }
    /** Returns the ping once it has arrived and is due; this ends the request. */
    types::SonarPtr due(types::Time now);
    /** Whether no ping has arrived in time; this ends the request. */
    bool failed(types::Time now);
    /** The next time at which due() or failed() can succeed, during a request. */
    types::Time next() const { return ping_ ? due_ : requests_.deadline(); }
    /** Returns the request to send to the sonar, once. */
    std::optional<types::SonarSettings> consumeRequest() { return std::exchange(unsent_, {}); }
    double speedOfSound() const { return speed_of_sound_; }  ///< Speed of sound in the water [m/s].
    /** Returns why the last ping was refused, once; empty: none was refused. */
    std::string consumeWarning() { return std::exchange(warning_, {}); }

private:
    void ask(types::Time now);

    types::SonarSettings wanted_;
    RequestedPings<> requests_;
    std::optional<types::SonarSettings> unsent_;
    double listens_ = 0, speed_of_sound_ = 1500;
    bool again_ = false;  ///< Requested a second time.
    types::Time due_;
    types::SonarPtr ping_;
    std::string warning_;
};

/** The common part of devices of the ping protocol: finding frames, answering general requests, acknowledging and
 *  refusing. A client that sends a message of the device without payload requests that message, as older drivers do.
 *
 *  Inputs and outputs are bytes by client, pings and requests for pings; there are no sockets. The clock, which may be
 *  set, is an argument. */
class PingDevice {
public:
    virtual ~PingDevice() = default;

    /** Takes bytes of a client. @param datagram true: whole frames; false: a part of a stream */
    void receive(PingClient client, std::span<const uint8_t> bytes, bool datagram, types::Time clock);
    /** Forgets a client: nothing is sent to it any more, and its requests are dropped. */
    void close(PingClient client);
    /** Takes a ping of the simulated sonar, in codes. */
    void setPing(const types::SonarPtr& ping, types::Time clock);
    /** Does the due work. */
    void tick(types::Time clock) { proceed(follow(clock)); }
    /** Returns when tick is needed next, also to see the clock while messages are ignored; none: not before an input.
     */
    std::optional<types::Time> wakeAt() const;

    std::vector<PingOutgoing> consumeOutgoing() { return std::exchange(outgoing_, {}); }
    std::optional<types::SonarSettings> consumeRequest();
    std::vector<std::string> consumeWarnings() { return std::exchange(warnings_, {}); }
    uint8_t id() const { return id_; }

protected:
    PingDevice(const PingDeviceInformation& information, const PingProtocolVersion& version, uint8_t id)
        : id_(id), information_(information), version_(version) {}

    // The times of these are steady.
    /** Executes a message. */
    virtual void command(PingClient client, const PingFrame& frame, types::Time now) = 0;
    /** Answers a request for one of the device's own messages; false: there is no such message. */
    virtual bool answer(PingClient client, uint16_t requested, types::Time now) = 0;
    virtual void forget(PingClient client) = 0;
    virtual void proceed(types::Time now) = 0;
    virtual std::optional<types::Time> nextWork() const = 0;  ///< As wakeAt.

    void send(PingClient client, const auto& message, bool stream = false) {
        add({client, pingBytes(message, id_), stream});
    }
    void acknowledge(PingClient client, uint16_t message) { send(client, PingAck{message}); }
    void refuse(PingClient client, uint16_t message, std::string why) {
        send(client, PingNack{message, std::move(why)});
    }
    /** Sets the device's id. */
    void setId(PingClient client, uint16_t message, uint8_t id, uint8_t min);
    /** Reads the message of a frame and passes it to `use`; refuses a message that is too short. */
    template <class Message, class Use>
    void with(PingClient client, const PingFrame& frame, Use&& use) {
        if (const auto message = pingMessage<Message>(frame))
            use(*message);
        else
            refuse(client, frame.message, "the payload is too short");
    }
    /** Warns once of missing pings, until a ping arrives. */
    void warnOfSilence();
    void noteReceived() { silent_ = false; }
    const PingDeviceInformation& information() const { return information_; }
    /** Ignores clients' messages until then. */
    void setDeaf(types::Time until) { deaf_until_ = until; }

    PingTurn turn_;

private:
    /** Reads the clock; returns the steady time. */
    types::Time follow(types::Time clock);
    void handle(PingClient client, const PingFrame& frame, types::Time now);
    void handleRequest(PingClient client, uint16_t requested, types::Time now);
    /** Bytes streamed to a client at once are one piece, which the next one replaces whole. */
    void add(PingOutgoing out);
    bool answerAny(PingClient client, uint16_t requested, types::Time now);

    uint8_t id_;
    PingDeviceInformation information_;
    PingProtocolVersion version_;
    std::map<PingClient, PingFrameReader> readers_;
    std::vector<PingOutgoing> outgoing_;
    std::vector<std::string> warnings_;
    bool silent_ = false;
    types::SteadyTime steady_;
    types::Time now_;  ///< At the last reading.
    types::Time deaf_until_;
};

}  // namespace insonify::device
