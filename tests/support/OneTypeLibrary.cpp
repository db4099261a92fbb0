// A user's component.
#include "components/framework/Port.hpp"
#include "components/framework/Registry.hpp"
#include "components/loader/Interface.hpp"

namespace {

class CounterTask final : public insonify::framework::TaskContext {
public:
    using TaskContext::TaskContext;
    insonify::framework::OutputPort<double> value{this, "value", "42, each cycle"};

private:
    void updateHook() override { value.write(42); }
};

}  // namespace

INSONIFY_COMPONENT_LIBRARY;

extern "C" void insonify_register(insonify::framework::Registry& registry) {
    registry.add<CounterTask>("one_type::CounterTask", "writes 42");
}
