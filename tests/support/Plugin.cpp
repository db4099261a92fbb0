#include "components/framework/Port.hpp"
#include "components/framework/Registry.hpp"
#include "components/loader/Interface.hpp"

using namespace insonify;

class PluginTask final : public framework::TaskContext {
public:
    using TaskContext::TaskContext;
    framework::OutputPort<double> value{this, "value", "42, each cycle"};

private:
    void updateHook() override { value.write(42); }
};

INSONIFY_COMPONENT_LIBRARY;

extern "C" void insonify_register(framework::Registry& registry) {
    registry.add<PluginTask>("plugin::PluginTask", "writes 42");
}
