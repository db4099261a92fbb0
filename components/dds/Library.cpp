// The component library dds: loaded by deployments that name a type of this namespace.
#include "components/dds/PublisherTask.hpp"
#include "components/loader/Interface.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" void insonify_register(insonify::framework::Registry& registry) { insonify::dds::registerTasks(registry); }
