#include "components/output/PictureTask.hpp"

#include <chrono>

#include "components/output/DiscImage.hpp"
#include "components/output/FanImage.hpp"
#include "components/output/WaterfallImage.hpp"

namespace insonify::output {

bool PictureTask::configureHook() {
    painter_ = makePainter(*config);
    return true;
}

bool PictureTask::startHook() {
    pings_ = 0;
    if (config->file || config->video) writer_ = std::make_unique<PictureWriter>(PictureFiles(*config, outputPath("")));
    return true;
}

void PictureTask::updateHook() {
    types::SonarPtr sample;
    if (!ping.readNew(sample)) return;
    const bool due = pings_++ % config->every == 0;
    if (due && (image.connected() || writer_))
        show(*sample);
    else
        painter_->skip(*sample);
}

void PictureTask::show(const types::Sonar& sample) {
    const auto begin = std::chrono::steady_clock::now();
    const auto picture = pool_.take();
    painter_->paint(sample, *picture);
    recordStage("paint", std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    pool_.stock(*picture);
    image.write(picture);
    if (writer_) writer_->write(picture);
}

void PictureTask::stopHook() {
    if (const auto writer = std::move(writer_)) writer->close();
}

void PictureTask::cleanupHook() { painter_.reset(); }

std::unique_ptr<Painter> FanImageTask::makePainter(const DisplayConfig& display) const {
    return std::make_unique<FanImage>(display);
}

std::unique_ptr<Painter> DiscImageTask::makePainter(const DisplayConfig& display) const {
    return std::make_unique<DiscImage>(display);
}

std::unique_ptr<Painter> WaterfallImageTask::makePainter(const DisplayConfig& display) const {
    return std::make_unique<WaterfallImage>(display);
}

}  // namespace insonify::output
