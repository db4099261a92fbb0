#include "components/deployer/Tasks.hpp"

#ifdef INSONIFY_DDS
#include "components/dds/PublisherTask.hpp"
#endif
#include "components/device/DeviceTask.hpp"
#ifdef INSONIFY_GAZEBO
#include "components/gazebo/PoseTask.hpp"
#endif
#include "components/logger/LoggerTask.hpp"
#include "components/mavlink/PoseTask.hpp"
#include "components/nav/ImuTask.hpp"
#include "components/noise/NoiseTask.hpp"
#include "components/output/PictureTask.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "components/receiver/ReceiverTask.hpp"
#include "components/replay/ReplayTask.hpp"
#include "components/scene/SceneTask.hpp"
#include "components/sonar/ScanningSonarTask.hpp"
#ifdef INSONIFY_VIEWER
#include "components/viewer/ViewerTask.hpp"
#endif

namespace insonify::deployer {

framework::Registry builtInTasks() {
    framework::Registry registry;
    pose::registerTasks(registry);
    mavlink::registerTasks(registry);
    nav::registerTasks(registry);
    scene::registerTasks(registry);
    sonar::registerTasks(registry);
    noise::registerTasks(registry);
    receiver::registerTasks(registry);
    output::registerTasks(registry);
    logger::registerTasks(registry);
    replay::registerTasks(registry);
    device::registerTasks(registry);
#ifdef INSONIFY_DDS
    dds::registerTasks(registry);
#else
    framework::leaveOut("dds::", "cyclonedds-dev");
#endif
#ifdef INSONIFY_GAZEBO
    gazebo::registerTasks(registry);
#else
    framework::leaveOut("gazebo::", "libignition-transport-dev and libignition-msgs-dev");
#endif
#ifdef INSONIFY_VIEWER
    viewer::registerTasks(registry);
#else
    framework::leaveOut("viewer::", "libboost-dev");
#endif
    return registry;
}

}  // namespace insonify::deployer
