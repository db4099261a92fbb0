#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/dds/Endpoints.hpp"
#include "components/dds/Node.hpp"
#include "components/dds/TransformConfig.hpp"
#include "components/pose/ListenerTask.hpp"
#include "components/ros/TransformTree.hpp"
#include "types/SenderClock.hpp"
#include "types/ThrottledWarning.hpp"

namespace insonify::dds {

/** What an output of TransformTask tells of. */
template <class Sample>
struct Told {
    std::string frame_id;
    types::Time time, written;           ///< Of the last pose: its chain's, and by the clock.
    uint64_t life = 0;                   ///< Of the tree, then.
    std::optional<types::Time> lacking;  ///< Since when there is none.
};

/** Tells where frames of ROS 2's tf lie in the world; for `schedule: realtime`.
 *
 *  Ports: an output for each of `frames`: body in the world, Rock's axes (x north, y west, z up). There is a pose for
 *  the newest time at which the whole chain of transforms between the frame and `world_frame_id` is known, each time
 *  that messages were taken; of a chain that is static, ten a second, stamped now. Velocities are unknown.
 *
 *  What is refused of the messages is counted: a warning tells it at the first and then every ten seconds at most, a
 *  notice the sum at the end. A chain that leads nowhere, goes in a circle or is cut is told so once that has gone on
 * for two seconds. Refused in lockstep, whose time does not wait for messages. */
class TransformTask final : public pose::ListenerTask<TransformConfig, &TransformConfig::frames, Told> {
public:
    using ListenerTask::ListenerTask;

    std::vector<std::string> notices() const override;
    /** For chains that are static. */
    double wakeAfter() const override { return 0.1; }

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;

    void take(Reader& reader, bool is_static);
    void add(const ros::TransformStamped& transform, bool is_static);
    template <class Output>
    void tell(Output& output);

    std::optional<Node> node_;
    std::unique_ptr<Reader> moving_, fixed_;
    ros::TransformTree tree_;
    Bytes bytes_;
    ros::TFMessage message_;
    types::ThrottledWarning drops_{"transform", "dropped"}, gaps_{"pose", "missing"};
};

}  // namespace insonify::dds
