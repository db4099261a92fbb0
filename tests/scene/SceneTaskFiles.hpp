#pragma once
// A scene's task between the vehicle's poses and its snapshots.
#include "components/scene/SceneTask.hpp"
#include "tests/scene/SceneFiles.hpp"
#include "tests/support/Ports.hpp"

namespace insonify::scene {

struct SceneTaskFiles : SceneFiles {
    /** @param rest of the scene's file, as for load(). */
    explicit SceneTaskFiles(const std::string& rest,
                            const framework::ConnPolicy& poses = framework::ConnPolicy::buffer(8)) {
        config_.file = write("scene.gltf", gltf(rest)).string();
        vehicle_.port.connectTo(task_.pose, poses);
        task_.snapshot.connectTo(out_.port, framework::ConnPolicy::buffer(8));
    }
    void start() {
        task_.config.set(config_);
        ASSERT_TRUE(task_.configure() && task_.start()) << task_.lastError();
    }
    static types::Pose at(double seconds, glm::dvec3 position, glm::dquat orientation = {1, 0, 0, 0}) {
        types::Pose pose;
        pose.time = types::Time::fromSeconds(seconds);
        pose.position = position;
        pose.orientation = orientation;
        return pose;
    }
    types::SnapshotPtr ping(const types::Pose& pose) {
        vehicle_.port.write(pose);
        task_.update();
        types::SnapshotPtr snapshot;
        out_.port.readNew(snapshot);
        return snapshot;
    }

    SceneConfig config_;
    SceneTask task_{"scene"};
    test::Writer<types::Pose> vehicle_{"vehicle"};
    test::Reader<types::SnapshotPtr> out_;
};

}  // namespace insonify::scene
