#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace insonify::types {

/** Returns whether a name is valid in ROS for a topic or node: "sonar", "auv/sonar" or "/auv/sonar". */
bool isRosName(std::string_view name);

/** Returns `name` with `prefix` before it, unless it begins with the prefix. */
std::string prefixed(const std::string& prefix, const std::string& name);

/** A renamed topic, as `-r node:from:=to` of ROS. */
struct TopicRemap {
    std::string node;  ///< Name of the node, without its namespace; empty: all nodes.
    std::string from, to;
};

/** The mapping of names in ROS 2 for one deployment. Empty members leave all names unchanged. */
struct RosNames {
    std::string ros_namespace;  ///< "/auv1"; empty: none.
    std::string frame_prefix;   ///< "auv1/", for frames except those of the world; empty: none.
    std::vector<TopicRemap> remaps;

    /** Sets the namespace from a text such as "auv1" or "/auv1". Returns false, and changes nothing, for a name that is
     *  invalid in ROS. */
    bool setNamespace(const std::string& text);
    /** Sets the prefix from a text such as "auv1" or "auv1/". Returns false, and changes nothing, for a name that is
     *  invalid for a frame. */
    bool setFramePrefix(std::string text);

    /** Returns the name of a topic for the node of that name. A name without a leading slash gets the namespace; then
     *  the first matching entry of `remaps` applies. */
    std::string topic(const std::string& name, const std::string& node = "") const;
    /** Returns the name of a node, in the namespace unless it has a leading slash. */
    std::string node(const std::string& name) const;
    std::string frame(const std::string& name) const { return prefixed(frame_prefix, name); }

private:
    std::string expanded(const std::string& name) const;
};

}  // namespace insonify::types
