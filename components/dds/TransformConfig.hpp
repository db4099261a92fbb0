#pragma once
#include <string>
#include <vector>

#include "components/dds/NodeConfig.hpp"
#include "components/dds/SubscriberConfig.hpp"

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

}  // namespace insonify::dds
