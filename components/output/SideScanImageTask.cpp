#include "components/output/SideScanImageTask.hpp"

namespace insonify::output {

std::unique_ptr<Painter> SideScanImageTask::makePainter() {
    auto painter = std::make_unique<SideScanImage>(*config);
    painter_ = painter.get();
    return painter;
}

void SideScanImageTask::updateHook() {
    if (types::Range measured; altitude.connected() && altitude.readNewest(measured) == framework::FlowStatus::NewData)
        painter_->setAltitude(measured.range);
    PictureTask::updateHook();
}

}  // namespace insonify::output
