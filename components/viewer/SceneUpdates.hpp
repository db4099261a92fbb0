#pragma once
#include <map>

#include "components/ros/Options.hpp"
#include "components/viewer/Frame.hpp"
#include "components/viewer/SceneMesh.hpp"

namespace insonify::viewer {

/** Encodes a scene as foxglove_msgs/SceneUpdate in CDR: an entity for each object that is shown, its points in the axes
 *  of the world. Not thread-safe. */
class SceneUpdates {
public:
    SceneUpdates(ros::WorldFrame axes, size_t max_triangles) : axes_(axes), max_triangles_(max_triangles) {}

    /** Returns whether the scene differs from that of the last whole(). */
    bool isNew(const types::Snapshot& snapshot) const { return snapshot.geometry && snapshot.geometry != geometry_; }
    /** Returns all objects at their present places, replacing earlier entities; null if there is no scene. */
    Bytes whole(const types::Snapshot& snapshot);
    /** Returns all objects that have moved or deformed since whole(), so that a message may replace the previous one;
     *  null if none has since the last message. */
    Bytes moved(const types::Snapshot& snapshot);

private:
    using Places = std::map<size_t, glm::dmat4>;
    /** The shapes of deformed objects. */
    struct Shapes {
        std::vector<types::DeformedObject> deformed;
        std::vector<types::JointPose> joints;
        std::vector<types::MorphPose> morphs;

        bool operator==(const Shapes&) const = default;
    };
    /** Adds the shown objects that a snapshot moves or deforms. */
    void addChanged(const types::Snapshot& snapshot, Places& places) const;
    Bytes makeMessage(const types::Snapshot& snapshot, const Places& places, bool all) const;

    ros::WorldFrame axes_;
    size_t max_triangles_;
    types::GeometryPtr geometry_;
    ShownScene shown_;
    Places home_;    ///< Places of the shown objects at the last whole().
    Places moved_;   ///< Places last sent, of objects that have ever moved or deformed.
    Shapes shapes_;  ///< Shapes last sent.
};

}  // namespace insonify::viewer
