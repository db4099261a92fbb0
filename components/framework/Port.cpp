#include "components/framework/Port.hpp"

#include "components/framework/Activity.hpp"

namespace insonify::framework {

void InputPortBase::signal() const {
    if (triggers_) owner().activity().trigger();
}

void OutputPortBase::noteWritten(types::Time stamp) const {
    const Activity& activity = owner().activity();
    if (!activity.realtime() || stamp.isNull()) return;
    const double seconds = (owner().environment().now() - stamp).seconds();
    const double deadline = activity.settings().deadline;
    owner().timing().noteLatency(seconds);
    owner().timing().late += deadline > 0 && seconds > deadline ? 1 : 0;
}

}  // namespace insonify::framework
