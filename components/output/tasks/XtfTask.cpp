#include "components/output/tasks/XtfTask.hpp"

#include "components/framework/Graph.hpp"
#include "components/output/PictureFiles.hpp"

namespace insonify::output {

void XtfConfig::check(types::Diagnostics& diagnostics) const {
    if (!findFileFormat(file, FileContent::SideScan))
        diagnostics.push_back({"file", "is " + file + "; must end in " + fileEndings(FileContent::SideScan)});
}

void XtfTask::check(types::Diagnostics& diagnostics) const {
    if (config->samples != recordings::XtfSamples::Uint16) return;
    if (const std::string why = framework::whyNoCodes(ping); !why.empty())
        diagnostics.push_back({"samples", "is uint16, which takes whole numbers from 0 to 65535, but " + why +
                                              "; put a receiver with output: code and code: {bits: 16} before it, or "
                                              "take samples: float32"});
}

bool XtfTask::startHook() {
    format_ = {config->samples, config->frequency_khz, config->file};
    next_ = {};
    has_pose_ = false;
    without_pose_ = 0;
    lost_ = 0;
    last_ = {};
    aligner_.clear(config->timeout);
    file_.emplace(outputPath(config->file));
    return true;
}

void XtfTask::updateHook() {
    if (types::Range measured; altitude.readNewest(measured) == framework::FlowStatus::NewData)
        next_.altitude = measured.isKnown() ? measured.range : 0;
    aligner_.update();
}

void XtfTask::write(const types::Sonar& line) {
    bytes_.clear();
    if (next_.number == 0) bytes_ = recordings::xtfHeader(format_, line);
    if (!has_pose_) {
        next_.sonar.position.x = types::Pose::unknown;
        ++without_pose_;
    }
    next_.since_last = last_.isNull() ? 0 : (line.time - last_).seconds();
    last_ = line.time;
    recordings::appendXtfPing(format_, line, next_, bytes_);
    ++next_.number;
    put();
}

void XtfTask::put() {
    if (!file_) return void(++lost_);
    const bool may_lose = environment().mayLose();
    try {
        if (!may_lose) return file_->append(bytes_);
        const bool is_lost = !file_->tryAppend(bytes_);
        lost_ += is_lost ? 1 : 0;
        if (is_lost) failure_ = "the disk is slower than the pings";
        if (slow_.isDue(is_lost)) warn(config->file + ": " + failure_ + ", some are lost");
    } catch (const std::exception& failure) {
        if (!may_lose) throw;
        // The remains of an incomplete ping would corrupt later pings.
        file_.reset();
        ++lost_;
        failure_ = failure.what();
        error(failure_ + "; the file ends here, and further pings are lost");
    }
}

void XtfTask::stopHook() {
    aligner_.flush();
    if (file_) file_->close();
    file_.reset();
}

types::Notices XtfTask::notices() const {
    types::Notices notices = aligner_.notices();
    if (without_pose_ > 0)
        notices.push_back(
            types::warning(std::to_string(without_pose_) + " pings of " + config->file + " have no pose"));
    if (lost_ > 0)
        notices.push_back(
            types::warning(std::to_string(lost_) + " pings are not in " + config->file + ": " + failure_));
    return notices;
}

}  // namespace insonify::output
