#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace insonify::types {

/** Whether ROS takes it for a name of a topic or node: "sonar", "auv/sonar" or "/auv/sonar". */
bool isRosName(std::string_view name);

/** `name` with `prefix` before it, unless it begins with that. */
std::string prefixed(const std::string& prefix, const std::string& name);

/** A topic that has another name: `-r node:from:=to` of ROS. */
struct TopicRemap {
    std::string node;  ///< Name of the node that has it, without its namespace; empty: all nodes have it.
    std::string from, to;
};

/** What names in ROS 2 become in one deployment. Without any member each name stays as it is. */
struct RosNames {
    std::string ros_namespace;  ///< "/auv1"; empty: none.
    std::string frame_prefix;   ///< "auv1/", of frames but those of the world; empty: none.
    std::vector<TopicRemap> remaps;

    /** Reads a namespace as it is written, "auv1" or "/auv1". False, and all as it was, for no name of ROS. */
    bool setNamespace(const std::string& text);
    /** Reads a prefix as it is written, "auv1" or "auv1/". False, and all as it was, for no name of a frame. */
    bool setFramePrefix(std::string text);

    /** A topic as the node of that name has it: a name without a leading slash is in the namespace, then the first of
     *  `remaps` that fits holds. */
    std::string topic(const std::string& name, const std::string& node = "") const;
    /** A node, in the namespace unless it has a leading slash. */
    std::string node(const std::string& name) const;
    std::string frame(const std::string& name) const { return prefixed(frame_prefix, name); }

private:
    std::string expanded(const std::string& name) const;
};

}  // namespace insonify::types
