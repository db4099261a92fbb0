#pragma once
#include <map>

#include "components/ros/Options.hpp"
#include "components/viewer/Frame.hpp"
#include "components/viewer/SceneMesh.hpp"

namespace insonify::viewer {

/** A scene as messages foxglove_msgs/SceneUpdate in CDR: an entity for each object that is shown, its points in the
 * axes of the world. Not for several threads. */
class SceneUpdates {
public:
    SceneUpdates(ros::WorldFrame axes, size_t max_triangles) : axes_(axes), max_triangles_(max_triangles) {}

    /** Whether the scene is another than that of the last whole(). */
    bool isNew(const types::Snapshot& snapshot) const { return snapshot.geometry && snapshot.geometry != geometry_; }
    /** All of it, where it is now, in the place of what was there before; null where there is no scene. */
    Bytes whole(const types::Snapshot& snapshot);
    /** All objects that have moved since whole(), so that a message may take the place of the one before; null: none
     * has since the last message. */
    Bytes moved(const types::Snapshot& snapshot);

private:
    using Places = std::map<size_t, glm::dmat4>;
    Bytes messageOf(const types::Snapshot& snapshot, const Places& places, bool all) const;

    ros::WorldFrame axes_;
    size_t max_triangles_;
    types::GeometryPtr geometry_;
    ShownScene shown_;
    Places home_;   ///< Of the objects that are shown.
    Places moved_;  ///< As it was told last, of those that were ever elsewhere.
};

}  // namespace insonify::viewer
