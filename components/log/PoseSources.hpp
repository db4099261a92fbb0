#pragma once
// Poses of a body from the streams of any log: odometry, poses, transforms of tf, fixes of satellites.
#include <optional>
#include <string>
#include <vector>

#include "components/log/Reader.hpp"
#include "types/geometry/Datum.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/text/Notice.hpp"

namespace insonify::log {

/** What of a log becomes the poses of a body. */
struct PoseSource {
    std::string source, stream = "pose";
    std::optional<types::Datum> datum = {};
    std::string orientation = {};

    static void describe(auto& self, auto& visit) {
        visit({"source", "", "a topic or a stream of poses or of fixes, or two frames of tf, as in map->base_link"},
              self.source);
        visit({"stream", "", "name that the stream of these poses gets, which connections lead from"}, self.stream);
        visit({"datum", "",
               "origin of the world, which a source of latitudes and longitudes needs; absent: the deployment's"},
              self.datum);
        visit(
            {"orientation", "",
             "topic or stream of an attitude or of poses that turns a body whose source has only positions; empty: it "
             "is level and looks to the north"},
            self.orientation);
    }
};

/** Whether poses are made from a stream. */
bool isSourceOf(const PoseSource& poses, const Stream& stream);

/** A stream, or two frames of tf, that could be the poses of a body. */
struct FoundPoses {
    std::string source;         ///< For PoseSource: "/odom", "vehicle.pose", "map->base_link".
    std::string type;           ///< Of its messages, or of its samples.
    std::string parent, child;  ///< Frames; empty: the messages do not name it.
    size_t count = 0;           ///< Messages, or transforms of the child to its parent [1].
    types::Time first{}, last{};
    bool has_fixes = false;  ///< Needs a datum.

    /** Returns "(nav_msgs/msg/Odometry, odom -> base_link, 20 in 1.9 s)". */
    std::string text() const;
};

/** Returns what could be poses: streams of poses and fixes with at least one sample; for each frame of tf that moves,
 *  its chain from its root, and its transform to its parent. Reads all messages of tf. */
std::vector<FoundPoses> findPoses(Reader& log);

/** Returns a table of them, a line each. */
std::string makeTable(const std::vector<FoundPoses>& found);

/** Makes the stream of a source's poses, in Rock's axes, at the times of their own stamps, or of their messages where
 *  these have none. A stream of the log that has this name already gets "_recorded" behind it.
 *
 *  A stream of poses is renamed; poses that are not usable are omitted. Frames of tf are followed as ros::TransformTree
 *  does: static transforms hold for the whole log, and after each message the newest time counts at which all
 *  transforms of the chain are known. Fixes become places about the datum; between the samples of `orientation` the
 *  body turns by slerp, and outside of them not at all.
 *
 *  Returns what was omitted or assumed. Throws ConfigError, with the sources that there are, for a source that cannot
 *  be used, or whose datum is another place than the world's. @param foreign axes of frames of tf
 *  @param world the datum of a source of fixes without its own */
types::Notices addPoses(Reader& log, const PoseSource& asked, types::WorldFrame foreign,
                        const std::optional<types::Datum>& world = {});

}  // namespace insonify::log
