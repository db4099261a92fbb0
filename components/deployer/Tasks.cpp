#include "components/deployer/Tasks.hpp"

#ifdef INSONIFY_DDS
#include "components/dds/PublisherTask.hpp"
#endif
#include "components/device/DeviceTask.hpp"
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
#endif
#ifdef INSONIFY_VIEWER
    viewer::registerTasks(registry);
#endif
    return registry;
}

}  // namespace insonify::deployer
