#include "components/output/tasks/SamplePictureTask.hpp"

#include <chrono>

namespace insonify::output {

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
    pool_.stock(*shown);
    image.write(shown);
    writeFile(shown);
}

template class SamplePictureTask<SoundingMap>;
template class SamplePictureTask<RangeImage>;

}  // namespace insonify::output
