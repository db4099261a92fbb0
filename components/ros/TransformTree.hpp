#pragma once
#include <deque>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/ros/Messages.hpp"
#include "types/Time.hpp"

namespace insonify::ros {

/** Transforms between frames, from /tf and /tf_static, and chains of them.
 *
 *  A frame has one parent. Transforms of /tf are kept for `memory` and interpolated between their stamps: position
 *  linearly, rotation by slerp the shorter way. Transforms of /tf_static hold for ever. Memory is bounded even if a
 *  sender invents names without end. */
class TransformTree {
public:
    static constexpr size_t max_frames = 1000, max_kept = 1000;
    static constexpr types::Time memory{10'000'000};
    static constexpr types::Time max_ahead{10'000'000};   ///< Ahead of the clock: localisation stamps ahead on purpose.
    static constexpr types::Time max_silence{1'000'000};  ///< After it another sender may take over a frame.

    /** Adds a transform with the given stamp. Returns why it is refused, or an empty text. Refused are: invalid names,
     *  numbers that are not finite, stamps far ahead or before the previous stamp, and frames that have another parent
     *  or come on the other topic. The last two hold until the frame has been silent for `max_silence`. */
    std::string add(const TransformStamped& transform, bool is_static, types::Time stamp, types::Time now);

    /** The pose of one frame in another. */
    struct Placed {
        types::Time time;  ///< The time for which the whole chain is known; 0 for a static chain.
        glm::dvec3 position{0};
        glm::dquat orientation{1, 0, 0, 0};
    };
    struct Found {
        std::optional<Placed> placed;
        std::string diagnostic;  ///< Why there is no pose, or which transform it waits for.
    };
    /** Returns the pose of `frame` in `world`, in their own axes, at the newest time for which all transforms between
     *  them are known. */
    Found newest(const std::string& world, const std::string& frame, types::Time now) const;
    /** Increases whenever a frame begins anew; newest() may then go back in time. */
    uint64_t lives() const { return lives_; }

private:
    struct Sample {
        types::Time time;
        glm::dvec3 position;
        glm::dquat orientation;
    };
    /** A frame's transforms to its parent. */
    struct Link {
        std::string parent;
        bool is_static = false;
        std::deque<Sample> samples;  ///< Sorted by time.
        types::Time came;
    };
    using Links = std::map<std::string, Link>;
    using Chain = std::vector<const Links::value_type*>;  ///< Transforms from a frame upwards.

    std::string findDiagnostic(const TransformStamped& transform, bool is_static, types::Time stamp,
                               types::Time now) const;
    /** Returns the chain from a frame to its root; none, with a `diagnostic`, for a circle. */
    std::optional<Chain> findChain(const std::string& frame, std::string& diagnostic) const;
    /** Returns the transform whose newest stamp is the oldest; null if all are static. */
    static const Links::value_type* findOldest(const Chain& up, const Chain& down);
    static std::optional<Sample> at(const Chain& chain, types::Time time);

    Links links_;
    uint64_t lives_ = 0;
};

}  // namespace insonify::ros
