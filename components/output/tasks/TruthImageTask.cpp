#include "components/output/tasks/TruthImageTask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace insonify::output {

bool TruthImageTask::startHook() {
    last_.reset();
    omitted_ = 0;
    return PairPictureTask::startHook();
}

void TruthImageTask::stopHook() {
    PairPictureTask::stopHook();
    last_.reset();
}

void TruthImageTask::show(const types::Sonar& sample) {
    if (!last_ || last_->time != sample.time) {
        ++omitted_;
        return;
    }
    picture_->setTruth(*last_);
    take(sample);
}

types::Notices TruthImageTask::notices() const {
    types::Notices notices = aligner_.notices();
    std::ranges::move(PictureTask::notices(), std::back_inserter(notices));
    if (omitted_ > 0)
        notices.push_back(types::warning(fmt::format("{} pings not shown because their truth is missing", omitted_)));
    return notices;
}

}  // namespace insonify::output
