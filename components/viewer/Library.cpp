// The component library viewer: loaded by deployments that name a type of this namespace.
#include "components/loader/Interface.hpp"
#include "components/viewer/ViewerTask.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" void insonify_register(insonify::framework::Registry& registry) {
    insonify::viewer::registerTasks(registry);
}
