#include "components/framework/execution/Timing.hpp"

#include <algorithm>
#include <cmath>

#include "components/framework/TaskContext.hpp"
#include "components/framework/execution/Activity.hpp"

namespace insonify::framework {
namespace {

constexpr double shortest = 1e-7;  // [s]
const double step = std::log(1.01);

}  // namespace

void Statistics::add(double seconds) {
    const double index = seconds > shortest ? std::ceil(std::log(seconds / shortest) / step) : 0;
    ++histogram_[static_cast<size_t>(std::min(index, steps - 1.0))];
    ++count_;
    max_ = std::max(max_, seconds);
}

double Statistics::quantile(double q) const {
    if (count_ == 0) return 0;
    const auto wanted = static_cast<uint64_t>(std::max(1.0, std::ceil(q * static_cast<double>(count_))));
    uint64_t seen = 0;
    for (size_t i = 0; i < histogram_.size(); ++i)
        if ((seen += histogram_[i]) >= wanted)
            return std::min(max_, shortest * std::exp(static_cast<double>(i) * step));
    return max_;
}

void noteLatency(TaskContext& task, types::Time stamp) {
    const Activity& activity = task.activity();
    if (!activity.realtime() || stamp.isNull()) return;
    const double seconds = (task.environment().now() - stamp).seconds();
    const double deadline = activity.settings().deadline;
    task.timing().noteLatency(seconds);
    task.timing().late += deadline > 0 && seconds > deadline ? 1 : 0;
}

}  // namespace insonify::framework
