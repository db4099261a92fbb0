#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/dds/Endpoints.hpp"
#include "components/dds/Node.hpp"
#include "components/dds/Subscription.hpp"
#include "components/pose/ListenerTask.hpp"
#include "components/ros/TransformTree.hpp"
#include "types/Time.hpp"
#include "types/text/Notice.hpp"

namespace insonify::dds {

/** One output port with the poses of one frame. */
struct FrameOut {
    std::string port = "pose";
    std::string frame_id = "base_link";

    static void describe(auto& self, auto& visit) {
        visit({"port", "", "output port that connections lead from"}, self.port);
        visit({"frame_id", "", "frame of the body"}, self.frame_id);
    }
};

struct TransformConfig {
    NodeConfig node;
    std::vector<FrameOut> frames;
    std::string world_frame_id = "map";
    std::string topic = "/tf", static_topic = "/tf_static";
    StampFrom stamp = StampFrom::Message;
    Reliability reliability = Reliability::BestEffort;

    TransformConfig();  // not inline: g++ 12 warns that its texts are uninitialized

    static void describe(auto& self, auto& visit) {
        visit({"frames", "", "frames whose poses are published"}, self.frames);
        visit({"world_frame_id", "", "reference frame of the poses; its axes are those of world_frame"},
              self.world_frame_id);
        visit({"topic", "", "topic of moving transforms"}, self.topic);
        visit({"static_topic", "", "topic of static transforms"}, self.static_topic);
        visit({"stamp", "",
               "time of a transform: its message's, or that of its arrival, for a sender whose clock is not ours "
               "(a simulator's, a bag's)"},
              self.stamp);
        visit({"reliability", "", "of moving transforms; reliable receives nothing from best-effort writers"},
              self.reliability);
        NodeConfig::describe(self.node, visit);
    }
    /** Resolves the names of topics, frames and the node in a deployment. @param task the name of the reading task */
    TransformConfig namedBy(const types::RosNames& names, const std::string& task) const;
    void check(types::Diagnostics& diagnostics) const;
};

/** The state of an output of TransformTask. */
template <class Sample>
struct SentFrame {
    std::string frame_id;
    types::Time time, written;           ///< Time of the last pose: its chain's, and the clock's.
    uint64_t life = 0;                   ///< TransformTree::lives() at the last pose.
    std::optional<types::Time> lacking;  ///< Since when there is no pose.
};

/** Publishes the poses of frames of ROS 2's tf in the world; for `schedule: realtime`.
 *
 *  Ports: an output for each of `frames`: body in the world, Rock's axes (x north, y west, z up). Each time that
 *  messages arrive, the pose is that of the newest time at which all transforms between the frame and `world_frame_id`
 *  are known. A chain of static transforms gives ten poses a second, stamped now. Velocities are unknown.
 *
 *  Refused transforms are counted. A warning reports the first and then at most one every ten seconds; a notice reports
 *  the sum at the end. A chain that leads nowhere, is circular or is interrupted is reported once, after two seconds.
 *  Refused in lockstep, whose time does not wait for messages. */
class TransformTask final : public pose::ListenerTask<TransformConfig, &TransformConfig::frames, SentFrame> {
public:
    using ListenerTask::ListenerTask;

    types::Notices notices() const override;
    /** Wakes up for static chains. */
    double wakeAfter() const override { return 0.1; }

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;

    void take(Reader& reader, bool is_static);
    void add(const ros::TransformStamped& transform, bool is_static);
    void report(auto& output);

    std::optional<Node> node_;
    std::unique_ptr<Reader> moving_, fixed_;
    ros::TransformTree tree_;
    Bytes bytes_;
    ros::TFMessage message_;
    types::ThrottledWarning drops_{"transform", "dropped"}, gaps_{"pose", "missing"};
};

}  // namespace insonify::dds
