#include "components/output/tasks/SamplePictureTask.hpp"

#include <chrono>
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
    const size_t queue = activity().realtime() ? 4 : 1;  // in lockstep a run waits for its pictures, and saves memory
    writer_ = std::make_unique<PictureWriter>(PictureFiles(config, outputPath("")), at_failure, queue);
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

template <class Picture>
bool SamplePictureTask<Picture>::configureHook() {
    prepareFiles(*config);
    picture_ = std::make_unique<Picture>(config->width, config->colour_map);
    if constexpr (std::is_same_v<Picture, SoundingMap>) picture_->setDatum(config->datum);
    return true;
}

template <class Picture>
bool SamplePictureTask<Picture>::startHook() {
    samples_ = 0;
    picture_->clear();
    openFiles(*config);
    return true;
}

template <class Picture>
void SamplePictureTask<Picture>::updateHook() {
    for (Sample sample; input.readNew(sample);) {
        picture_->add(sample);
        if (++samples_ % config->every == 0 && (image.connected() || hasFiles())) show();
    }
    followFiles();
}

template <class Picture>
void SamplePictureTask<Picture>::show() {
    const auto begin = std::chrono::steady_clock::now();
    const auto shown = pool_.take();
    picture_->paint(*shown);
    recordStage("paint", std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    if (image.connected() || activity().realtime()) pool_.stock(*shown);
    image.write(shown);
    writeFile(shown);
}

template class SamplePictureTask<SoundingMap>;
template class SamplePictureTask<RangeImage>;

}  // namespace insonify::output
