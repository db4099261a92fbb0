#include "components/output/SoundingMapTask.hpp"

#include <chrono>

namespace insonify::output {

bool SoundingMapTask::configureHook() {
    map_ = std::make_unique<SoundingMap>(config->width, config->colour_map);
    return true;
}

bool SoundingMapTask::startHook() {
    clouds_ = 0;
    map_->clear();
    if (config->file || config->video) writer_ = std::make_unique<PictureWriter>(PictureFiles(*config, outputPath("")));
    return true;
}

void SoundingMapTask::updateHook() {
    for (types::PointCloudPtr cloud; soundings.readNew(cloud);) {
        map_->add(cloud);
        if (++clouds_ % config->every == 0 && (image.connected() || writer_)) show();
    }
}

void SoundingMapTask::show() {
    const auto begin = std::chrono::steady_clock::now();
    const auto picture = pool_.take();
    map_->paint(*picture);
    recordStage("paint", std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    pool_.stock(*picture);
    image.write(picture);
    if (writer_) writer_->write(picture);
}

void SoundingMapTask::stopHook() {
    if (const auto writer = std::move(writer_)) writer->close();
}

}  // namespace insonify::output
