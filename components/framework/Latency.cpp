#include "components/framework/Latency.hpp"

#include "components/framework/Activity.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

void noteLatency(TaskContext& task, types::Time stamp) {
    const Activity& activity = task.activity();
    if (!activity.realtime() || stamp.isNull()) return;
    const double seconds = (task.environment().now() - stamp).seconds();
    const double deadline = activity.settings().deadline;
    task.timing().noteLatency(seconds);
    task.timing().late += deadline > 0 && seconds > deadline ? 1 : 0;
}

}  // namespace insonify::framework
