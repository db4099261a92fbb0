#include "components/framework/Port.hpp"

#include "components/framework/Activity.hpp"
#include "components/framework/Latency.hpp"

namespace insonify::framework {

void InputPortBase::signal() const {
    if (triggers_) owner().activity().trigger();
}

bool InputPortBase::newestCounts() const { return owner().activity().realtime(); }

void OutputPortBase::noteWritten(types::Time stamp) const { noteLatency(owner(), stamp); }

}  // namespace insonify::framework
