#include "components/output/tasks/RecordingTask.hpp"

#include <utility>

#include "types/text/ConfigError.hpp"

namespace insonify::output {

void RecordingTask::prepareFiles(const RecordingConfig& config) const try {
    if (config.video) loadCodecs();
} catch (const types::ConfigError& error) {
    throw types::ConfigError("", name() + ".video", error.diagnostics().front().text());
}

void RecordingTask::openFiles(const RecordingConfig& config) {
    health_ = {};
    if (!config.file && !config.video) return;
    const auto at_failure = environment().mayLose() ? AtPictureFailure::Count : AtPictureFailure::Throw;
    writer_ = std::make_unique<PictureWriter>(PictureFiles(config, outputPath("")), at_failure);
}

void RecordingTask::skipFile() {
    if (writer_) writer_->skip();
}

void RecordingTask::writeFile(const types::ImagePtr& picture) {
    if (writer_) writer_->write(picture);
}

void RecordingTask::followFiles() {
    if (!writer_) return;
    const bool failed = std::exchange(health_, writer_->health()).fails;
    if (health_.fails && state() != framework::TaskState::RunTimeError)
        error(health_.failure + "; pictures are lost until one can be written");
    else if (failed && !health_.fails && state() == framework::TaskState::RunTimeError)
        recover();
}

void RecordingTask::stopHook() {
    const auto writer = std::move(writer_);
    if (!writer) return;
    writer->close();
    health_ = writer->health();
}

}  // namespace insonify::output
