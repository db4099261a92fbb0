#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/device/AskedPings.hpp"
#include "components/device/PingProtocol.hpp"
#include "types/Sonar.hpp"
#include "types/SonarSettings.hpp"

namespace insonify::device {

/** Who is connected, by a number that whoever moves the bytes gives. */
using PingClient = uint64_t;

/** What is to be sent. */
struct PingOutgoing {
    PingClient client = 0;
    Bytes bytes;
    bool stream = false;  ///< One of many of which the newest counts; false: an answer.
};

/** A value that a client sets, and what the device takes. */
struct PingBound {
    const char* name;
    uint32_t value, min, max;
};

/** What is wrong with the first value that is out of bounds: "angle is 400; must be 0 to 399"; empty: nothing. */
std::string diagnosticOf(std::initializer_list<PingBound> bounds);

/** A ping's codes as those of 8 bits. @param most the largest code of the receiver */
Bytes bytesOfCodes(std::span<const float> codes, double most);

/** A ping that is asked of a simulated sonar and waited for: one at a time.
 *
 *  Devices count echoes by time. What range that is, the sonar's own speed of sound tells, which its pings carry: one
 *  that shows another than the ping was asked by is asked for again. */
class PingTurn {
public:
    /** Asks for a ping that listens for `listens` [s] and is answered no sooner than `after` from now [s].
     *  @param wanted all but time and range */
    void ask(types::SonarSettings wanted, double listens, double after, types::Time now);
    /** Takes a ping that answers what was asked; else false. */
    bool take(const types::SonarPtr& ping, types::Time now);
    void drop() {
        asked_.clear();
        ping_.reset();
    }

    bool underWay() const { return ping_ || !asked_.empty(); }
    /** The ping, once it has come and is due; then nothing is under way. */
    types::SonarPtr due(types::Time now);
    /** Whether no ping came in good time; then nothing is under way. */
    bool failed(types::Time now);
    /** When one of these can be true next; while under way. */
    types::Time next() const { return ping_ ? due_ : asked_.deadline(); }
    /** What the sonar is to be asked, once. */
    std::optional<types::SonarSettings> takeAsked() { return std::exchange(unsent_, {}); }
    double speedOfSound() const { return speed_of_sound_; }  ///< Of the water [m/s].
    /** Why the last ping was not taken, once; empty: all were. */
    std::string takeWarning() { return std::exchange(warning_, {}); }

private:
    void ask(types::Time now);

    types::SonarSettings wanted_;
    AskedPings<> asked_;
    std::optional<types::SonarSettings> unsent_;
    double listens_ = 0, speed_of_sound_ = 1500;
    bool again_ = false;  ///< Asked a second time.
    types::Time due_;
    types::SonarPtr ping_;
    std::string warning_;
};

/** What devices of the ping protocol do alike: they find frames, answer general requests, acknowledge and refuse. A
 *  message that the device tells, sent to it without payload, asks for it as well, as older drivers do.
 *
 *  Bytes go in by client, bytes come out by client, and pings are asked for; it has no sockets and no clock. */
class PingDevice {
public:
    virtual ~PingDevice() = default;

    /** Bytes of a client. @param datagram they are whole frames; false: a piece of a line */
    void receive(PingClient client, std::span<const uint8_t> bytes, bool datagram, types::Time now);
    /** A client is gone: nothing is sent to it any more, and what it waited for is dropped. */
    void close(PingClient client);
    /** A ping of the simulated sonar, in codes. */
    void hear(const types::SonarPtr& ping, types::Time now);
    /** Lets time pass. */
    void tick(types::Time now) { proceed(now); }
    /** When tick is needed next; none: not before something comes. */
    virtual std::optional<types::Time> wakeAt() const = 0;

    std::vector<PingOutgoing> takeOutgoing() { return std::exchange(outgoing_, {}); }
    std::optional<types::SonarSettings> takeAsked() { return turn_.takeAsked(); }
    std::vector<std::string> takeWarnings() { return std::exchange(warnings_, {}); }
    uint8_t id() const { return id_; }

protected:
    PingDevice(const PingDeviceInformation& information, const PingProtocolVersion& version, uint8_t id)
        : id_(id), information_(information), version_(version) {}

    /** Does what a message asks for. */
    virtual void command(PingClient client, const PingFrame& frame, types::Time now) = 0;
    /** Answers a request for a message that is the device's own; false: there is none. */
    virtual bool answer(PingClient client, uint16_t requested, types::Time now) = 0;
    virtual void forget(PingClient client) = 0;
    virtual void proceed(types::Time now) = 0;

    template <class Message>
    void send(PingClient client, const Message& message, bool stream = false) {
        add({client, pingBytes(message, id_), stream});
    }
    void acknowledge(PingClient client, uint16_t message) { send(client, PingAck{message}); }
    void refuse(PingClient client, uint16_t message, std::string why) {
        send(client, PingNack{message, std::move(why)});
    }
    /** Gives the device another id. */
    void setId(PingClient client, uint16_t message, uint8_t id, uint8_t min);
    /** Reads the message that a frame holds and hands it on; one that is too short is refused. */
    template <class Message, class Use>
    void with(PingClient client, const PingFrame& frame, Use&& use) {
        if (const auto message = pingMessage<Message>(frame))
            use(*message);
        else
            refuse(client, frame.message, "the payload is too short");
    }
    /** Tells of pings that do not come, until one does. */
    void warnOfSilence();
    void noteHeard() { silent_ = false; }
    const PingDeviceInformation& information() const { return information_; }
    /** Until then nothing is heard of what clients say. */
    void setDeaf(types::Time until) { deaf_until_ = until; }

    PingTurn turn_;

private:
    void handle(PingClient client, const PingFrame& frame, types::Time now);
    void handleRequest(PingClient client, uint16_t requested, types::Time now);
    /** What is streamed to a client at once is one piece, which the next displaces whole. */
    void add(PingOutgoing out);
    bool answerAny(PingClient client, uint16_t requested, types::Time now);

    uint8_t id_;
    PingDeviceInformation information_;
    PingProtocolVersion version_;
    std::map<PingClient, PingFrameReader> readers_;
    std::vector<PingOutgoing> outgoing_;
    std::vector<std::string> warnings_;
    bool silent_ = false;
    types::Time deaf_until_;
};

}  // namespace insonify::device
