#pragma once
#include <set>
#include <string>
#include <vector>

#include "components/dds/NodeConfig.hpp"
#include "components/dds/SubscriberConfig.hpp"

namespace insonify::dds {

/** One frame's place as one port's poses. */
struct FrameOut {
    std::string port = "pose";
    std::string frame_id = "base_link";

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"port", "", "output port that connections lead from"}, self.port);
        visit(Field{"frame_id", "", "of the body"}, self.frame_id);
    }
};

struct TransformConfig {
    NodeConfig node;
    std::vector<FrameOut> frames;
    std::string world_frame_id = "map";
    std::string topic = "/tf", static_topic = "/tf_static";
    StampFrom stamp = StampFrom::Message;
    Reliability reliability = Reliability::BestEffort;

    TransformConfig();  // not in line: g++ 12 takes its texts for uninitialized

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"frames", "", "of which poses are told"}, self.frames);
        visit(Field{"world_frame_id", "", "the frame that they are told in; its axes are those of world_frame"},
              self.world_frame_id);
        visit(Field{"topic", "", "of what moves"}, self.topic);
        visit(Field{"static_topic", "", "of what does not"}, self.static_topic);
        visit(Field{"stamp", "",
                    "time of a transform: its message's, or that of its arrival, for a sender whose clock is not ours "
                    "(a simulator's, a bag's)"},
              self.stamp);
        visit(Field{"reliability", "", "of what moves; reliable hears no best-effort writers"}, self.reliability);
        NodeConfig::describe(self.node, visit);
    }
    /** With the names that topics, frames and the node have in a deployment. @param task that reads */
    TransformConfig namedBy(const types::RosNames& names, const std::string& task) const;
    void check(types::Diagnostics& diagnostics) const;
};

}  // namespace insonify::dds
