// The component library nav, which is loaded by deployments that name a type of this namespace.
#include "components/loader/Interface.hpp"
#include "components/nav/SensorTask.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" void insonify_register(insonify::framework::Registry& registry) { insonify::nav::registerTasks(registry); }
