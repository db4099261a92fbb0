#include "components/output/tasks/PairPictureTask.hpp"

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

void ScanMosaicTask::keep(const types::Pose& body) {
    if (types::isUsable(body)) before_ = body;
}

bool ScanMosaicTask::startHook() {
    before_.reset();
    laid_ = held_ = omitted_ = 0;
    held_for_ = 0;
    return PairPictureTask::startHook();
}

void ScanMosaicTask::show(const types::Sonar& sample) {
    std::optional<types::Pose> sonar = bodyAt(sample.time);
    if (sonar) types::place(types::Pose(*sonar), config->mount, *sonar);
    const bool usable = picture_->place(sonar);
    ++(sonar && usable ? laid_ : omitted_);
    describeMap(caption_);
    picture_->setCaption(caption_);
    take(sample);
}

std::optional<types::Pose> ScanMosaicTask::bodyAt(types::Time time) {
    const types::Pose* after = poses_.next();
    if (after && !types::isUsable(*after)) after = nullptr;
    if (before_ && before_->time == time) return before_;
    if (!before_ && !after) return std::nullopt;
    if (!before_) return held(*after, time);
    if (!after) return held(*before_, time);
    if (before_->time > time || after->time < time)  // stamps went back between them
        return held(before_->time > time ? *after : *before_, time);
    types::Pose body = *before_;
    interpolate(*before_, *after, (time - before_->time).seconds() / (after->time - before_->time).seconds(), body);
    return body;
}

types::Pose ScanMosaicTask::held(const types::Pose& nearest, types::Time time) {
    ++held_;
    held_for_ = std::max(held_for_, std::abs((time - nearest.time).seconds()));
    return nearest;
}

void ScanMosaicTask::describeMap(std::string& text) const {
    text.clear();
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "each ping at its pose, north up: {} pings", laid_);
    if (held_ > 0) fmt::format_to(out, ", {} at a pose held for up to {:.3g} s", held_, held_for_);
    if (omitted_ > 0) fmt::format_to(out, ", {} not shown because they have no usable pose", omitted_);
}

types::Notices ScanMosaicTask::notices() const {
    types::Notices notices = aligner_.notices();
    std::ranges::move(PictureTask::notices(), std::back_inserter(notices));
    if (held_ + omitted_ > 0) {
        std::string map;
        describeMap(map);
        notices.push_back(types::warning(map));
    }
    return notices;
}

}  // namespace insonify::output
