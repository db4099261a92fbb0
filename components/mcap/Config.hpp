#pragma once
#include "components/ros/Options.hpp"

namespace insonify::mcap {

/** How samples become messages. The defaults lose nothing of what a ping holds in its bins. */
struct McapConfig : ros::SonarOptions {
    ros::WorldFrame world_frame = ros::WorldFrame::AsIs;

    McapConfig() { dtype = ros::ImageType::Float32; }

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        ros::SonarOptions::describe(self, visit);
        visit(types::Field{"world_frame", "", "axes of poses: Rock's as they are, ENU or NED"}, self.world_frame);
    }
};

}  // namespace insonify::mcap
