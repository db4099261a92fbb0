#include "components/output/TruthImageTask.hpp"

#include <fmt/format.h>

namespace insonify::output {

void TruthImageConfig::check(types::Diagnostics& diagnostics) const {
    PictureConfig::check(diagnostics);
    if (width < 512)
        diagnostics.push_back({"width", fmt::format("is {} px; two pictures side by side take 512", width)});
}

std::unique_ptr<Painter> TruthImageTask::makePainter() {
    auto picture = std::make_unique<TruthImage>(*config);
    picture_ = picture.get();
    return picture;
}

bool TruthImageTask::startHook() {
    aligner_.clear(config->timeout);
    last_.reset();
    left_out_ = 0;
    return PictureTask::startHook();
}

void TruthImageTask::stopHook() {
    aligner_.flush();
    last_.reset();
    PictureTask::stopHook();
}

void TruthImageTask::show(const types::Sonar& sample) {
    if (!last_ || last_->time != sample.time) {
        ++left_out_;
        return;
    }
    picture_->regard(*last_);
    take(sample);
}

std::vector<std::string> TruthImageTask::notices() const {
    std::vector<std::string> notices = aligner_.notices();
    if (left_out_ > 0) notices.push_back(fmt::format("Warning: {} pings not shown for want of their truth", left_out_));
    return notices;
}

}  // namespace insonify::output
