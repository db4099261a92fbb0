#include "components/deployer/Tasks.hpp"

#ifdef INSONIFY_DDS
#include "components/dds/registerTasks.hpp"
#endif
#include "components/logger/registerTasks.hpp"
#include "components/noise/registerTasks.hpp"
#include "components/output/registerTasks.hpp"
#include "components/pose/registerTasks.hpp"
#include "components/receiver/registerTasks.hpp"
#include "components/replay/registerTasks.hpp"
#include "components/scene/registerTasks.hpp"
#include "components/sonar/registerTasks.hpp"
#ifdef INSONIFY_VIEWER
#include "components/viewer/registerTasks.hpp"
#endif

namespace insonify::deployer {

framework::Registry builtInTasks() {
    framework::Registry registry;
    pose::registerTasks(registry);
    scene::registerTasks(registry);
    sonar::registerTasks(registry);
    noise::registerTasks(registry);
    receiver::registerTasks(registry);
    output::registerTasks(registry);
    logger::registerTasks(registry);
    replay::registerTasks(registry);
#ifdef INSONIFY_DDS
    dds::registerTasks(registry);
#endif
#ifdef INSONIFY_VIEWER
    viewer::registerTasks(registry);
#endif
    return registry;
}

}  // namespace insonify::deployer
