#pragma once
#include <deque>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/ros/GeometryMessages.hpp"
#include "types/Time.hpp"

namespace insonify::ros {

/** Where frames lie in each other, as /tf and /tf_static tell, and chains of them.
 *
 *  A frame has one parent. Transforms of /tf are kept for `memory` and interpolated between their stamps, position
 *  linearly and rotation by slerp the shorter way; those of /tf_static hold for ever. Everything is bounded: whoever
 *  sends names without end fills no memory. */
class TransformTree {
public:
    static constexpr size_t max_frames = 1000, max_kept = 1000;
    static constexpr types::Time memory{10'000'000};
    static constexpr types::Time max_ahead{10'000'000};   ///< Of the clock: localisation stamps ahead on purpose.
    static constexpr types::Time max_silence{1'000'000};  ///< After it others may tell of a frame, and begin anew.

    /** Takes a transform of that stamp. Empty, or why it is refused: names that are none, numbers that are not finite,
     * a stamp far ahead or before the one before, a frame that another parent or the other topic has told of. The last
     *  two hold until nothing has come of the frame for `max_silence`. */
    std::string add(const TransformStamped& transform, bool is_static, types::Time stamp, types::Time now);

    /** One frame in another. */
    struct Placed {
        types::Time time;  ///< For which all of the chain is known; 0 where all of it is static.
        glm::dvec3 position{0};
        glm::dquat orientation{1, 0, 0, 0};
    };
    struct Found {
        std::optional<Placed> placed;
        std::string diagnostic;  ///< Why there is none, or which transform it waits for.
    };
    /** Where `frame` lies in `world`, in their own axes, at the newest time for which all between them is known. */
    Found newest(const std::string& world, const std::string& frame, types::Time now) const;
    /** Counts up where a frame has begun anew: then newest() may go back. */
    uint64_t lives() const { return lives_; }

private:
    struct Sample {
        types::Time time;
        glm::dvec3 position;
        glm::dquat orientation;
    };
    /** A frame in its parent. */
    struct Link {
        std::string parent;
        bool is_static = false;
        std::deque<Sample> samples;  ///< By time.
        types::Time came;
    };
    using Links = std::map<std::string, Link>;
    using Chain = std::vector<const Links::value_type*>;  ///< From a frame up.

    std::string diagnosticOf(const TransformStamped& transform, bool is_static, types::Time stamp,
                             types::Time now) const;
    /** Empty, with `diagnostic`: it goes in a circle. */
    std::optional<Chain> chainOf(const std::string& frame, std::string& diagnostic) const;
    /** Whose newest stamp is the oldest; null: all are static. */
    static const Links::value_type* oldestOf(const Chain& up, const Chain& down);
    static std::optional<Sample> at(const Chain& chain, types::Time time);

    Links links_;
    uint64_t lives_ = 0;
};

}  // namespace insonify::ros
