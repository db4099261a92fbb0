#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/mavlink/Messages.hpp"
#include "components/mavlink/PoseConfig.hpp"
#include "types/Pose.hpp"
#include "types/SenderClock.hpp"

namespace insonify::mavlink {

/** Poses in our axes (world x north, y west, z up; body x forward, y left, z up) of messages in MAVLink's. What the
 *  message does not tell is unknown; the time stays 0. */
types::Pose poseOf(const AttitudeQuaternion& attitude, const LocalPositionNed& position);
types::Pose poseOf(const VisionPositionEstimate& estimate);

/** Who sends: the same component by two ways is two. */
struct Sender {
    uint64_t way = 0;  ///< One number for each address that datagrams come from.
    uint8_t component = 0;
    friend bool operator==(const Sender&, const Sender&) = default;
};

/** Makes poses of the messages of one body.
 *
 *  Every attitude gives a pose: with the newest position, carried on by its velocity to the instant of the attitude,
 *  which is at most `max_gap` away. Both count from the same boot, by 32 bits of milliseconds that begin again after
 *  49.7 days. Every vision estimate is a pose. Stamps are carried over to our clock by SenderClock. One sender counts
 * at a time, until it has been silent for `max_silence`. */
class Body {
public:
    static constexpr types::Time max_gap{500'000};
    static constexpr types::Time max_silence{1'000'000};  ///< Of a sender, before another is believed.
    static constexpr types::Time patience{2'000'000};     ///< With an estimate of which a half stays away.

    Body(const BodyConfig& config, glm::dvec3 origin) : config_(config), origin_(origin) {}

    struct Taken {
        std::optional<types::Pose> pose;
        std::string diagnostic;  ///< Why the message was dropped; empty: it was not.
    };
    /** Whether a message of its source is of this body. */
    bool isOf(const Frame& frame) const;
    /** Whether a message is one that its source is made of. */
    bool wants(uint32_t message) const;
    Taken take(const Frame& frame, uint64_t way, types::Time now);
    /** The messages that it is made of and that have not come of late. */
    std::vector<uint32_t> missing(types::Time now) const;
    const BodyConfig& config() const { return config_; }

private:
    Taken take(const AttitudeQuaternion& attitude, types::Time now);
    Taken take(const LocalPositionNed& position, types::Time now);
    Taken take(const VisionPositionEstimate& estimate, types::Time now);
    /** At a stamp of the sender's clock. */
    Taken stamped(types::Pose pose, const types::SenderClock::Reading& reading) const;
    /** A half that came without the other: a diagnostic once that has gone on for a while. */
    std::string incomplete(const char* came, const char* lacks, types::Time now);
    /** Without beginning again after 49.7 days. */
    types::Time sinceBoot(uint32_t milliseconds) const;
    bool listensTo(const Sender& sender, types::Time now);

    BodyConfig config_;
    glm::dvec3 origin_;
    std::optional<Sender> sender_;
    types::Time sender_came_, attitude_came_, position_came_, vision_came_;
    std::optional<types::Time> incomplete_since_;
    std::optional<LocalPositionNed> position_;
    std::optional<uint32_t> boot_ms_;  ///< Of the newest attitude.
    types::Time since_boot_;           ///< The same, without beginning again.
    types::SenderClock clock_;
};

}  // namespace insonify::mavlink
