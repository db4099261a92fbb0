#include "components/output/SamplePictureTask.hpp"

#include <chrono>
#include <utility>

namespace insonify::output {

template <class Picture>
bool SamplePictureTask<Picture>::configureHook() {
    picture_ = std::make_unique<Picture>(config->width, config->colour_map);
    return true;
}

template <class Picture>
bool SamplePictureTask<Picture>::startHook() {
    samples_ = 0;
    picture_->clear();
    health_ = {};
    const bool heals = environment().deployment && !environment().lockstep;
    if (config->file || config->video)
        writer_ = std::make_unique<PictureWriter>(PictureFiles(*config, outputPath("")),
                                                  heals ? AtPictureFailure::Count : AtPictureFailure::Throw);
    return true;
}

template <class Picture>
void SamplePictureTask<Picture>::updateHook() {
    for (Sample sample; input.readNew(sample);) {
        picture_->add(sample);
        if (++samples_ % config->every == 0 && (image.connected() || writer_)) show();
    }
    if (writer_) followHealth();
}

template <class Picture>
void SamplePictureTask<Picture>::followHealth() {
    const PictureHealth before = std::exchange(health_, writer_->health());
    if (health_.fails && state() != framework::TaskState::RunTimeError)
        error(health_.failure + "; pictures are lost until one can be written");
    else if (!health_.fails && before.fails && state() == framework::TaskState::RunTimeError)
        recover();
}

template <class Picture>
void SamplePictureTask<Picture>::show() {
    const auto begin = std::chrono::steady_clock::now();
    const auto shown = pool_.take();
    picture_->paint(*shown);
    recordStage("paint", std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    pool_.stock(*shown);
    image.write(shown);
    if (writer_) writer_->write(shown);
}

template <class Picture>
void SamplePictureTask<Picture>::stopHook() {
    const auto writer = std::move(writer_);
    if (!writer) return;
    writer->close();
    health_ = writer->health();
}

template class SamplePictureTask<SoundingMap>;
template class SamplePictureTask<RangeImage>;

}  // namespace insonify::output
