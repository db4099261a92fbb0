#include "components/output/tasks/PictureTask.hpp"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "components/framework/Graph.hpp"
#include "components/output/tasks/PairPictureTask.hpp"
#include "components/output/tasks/SamplePictureTask.hpp"
#include "components/output/tasks/SideScanImageTask.hpp"
#include "components/output/tasks/XtfTask.hpp"

namespace insonify::output {

bool PictureTask::configureHook() {
    prepareFiles(pictureConfig());
    painter_ = makePainter();
    return true;
}

bool PictureTask::startHook() {
    pings_ = 0;
    last_.reset();
    openFiles(pictureConfig());
    return true;
}

void PictureTask::updateHook() {
    types::SonarPtr sample;
    if (!ping.readNew(sample)) return;
    take(*sample);
    last_ = showsTurns() && pings_ < pictureConfig().every ? std::move(sample) : nullptr;
}

void PictureTask::stopHook() {
    if (const types::SonarPtr last = std::move(last_); last && isWanted() && !environment().rehearsing) show(*last);
    RecordingTask::stopHook();
}

void PictureTask::take(const types::Sonar& sample) {
    const uint32_t every = pictureConfig().every;
    const bool due = pings_++ % every == (showsTurns() ? every - 1 : 0);
    if (environment().rehearsing) {
        if (due) skipFile();
        return;
    }
    if (due && isWanted())
        show(sample);
    else
        painter_->skip(sample);
    followFiles();
}

void PictureTask::check(types::Diagnostics& diagnostics) const {
    if (pictureConfig().scale != BinScale::Code) return;
    if (const std::string why = framework::whyNoCodes(ping); !why.empty())
        diagnostics.push_back({"scale", "is code, but " + why + "; take linear for intensities, decibel for levels"});
}

std::string PictureTask::indivisible() const {
    const PictureConfig& config = pictureConfig();
    if (!showsOne()) return "its pictures also show earlier pings; make them from the joined log";
    if (config.video) return "video: is one file of all pictures; make it from the joined log";
    if (config.scale != BinScale::Code && !config.reference_db)
        return "reference_db: is absent, so the brightest colour follows the echoes from ping to ping; set it";
    return {};
}

void PictureTask::show(const types::Sonar& sample) {
    const auto begin = std::chrono::steady_clock::now();
    const auto picture = pool_.take();
    paint(sample, *picture);
    recordStage("paint", std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    if (image.connected() || activity().realtime()) pool_.stock(*picture);
    image.write(picture);
    writeFile(picture);
}

void PictureTask::paint(const types::Sonar& sample, types::Image& picture) try {
    painter_->paint(sample, picture);
} catch (const cv::Exception& failure) {
    throw std::runtime_error(fmt::format(
        "cannot draw {} beams x {} bins to {:g} m in a picture {} pixels wide; try another `width` (OpenCV: {})",
        sample.beam_count, sample.bin_count, sample.binStart(sample.bin_count), pictureConfig().width, failure.err));
}

void PictureTask::cleanupHook() { painter_.reset(); }

void registerTasks(framework::Registry& registry) {
    registry.add<FanImageTask>("output::FanImageTask", "shows the pings of a forward-looking sonar as fans");
    registry.add<DiscImageTask>("output::DiscImageTask", "shows the pings of a scanning sonar on a disc");
    registry.add<WaterfallImageTask>("output::WaterfallImageTask", "shows range against time");
    registry.add<SideScanImageTask>("output::SideScanImageTask", "shows the lines of a side-scan sonar against time");
    registry.add<SoundingMapTask>("output::SoundingMapTask", "charts soundings from above, coloured by height");
    registry.add<RangeImageTask>("output::RangeImageTask", "shows the ranges of a 3-D sonar by direction");
    registry.add<XtfTask>("output::XtfTask", "writes the lines of a side-scan sonar as an XTF file");
    registry.add<ScanMosaicTask>("output::ScanMosaicTask",
                                 "shows the pings of a moving scanning sonar on a map, next to the disc");
    registry.add<TruthImageTask>("output::TruthImageTask",
                                 "shows pings as fans, next to the same fans coloured by object");
}

}  // namespace insonify::output
