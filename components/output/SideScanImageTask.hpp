#pragma once
#include "components/output/PictureTask.hpp"
#include "components/output/SideScanImage.hpp"

namespace insonify::output {

/** Shows the pings of a side-scan sonar: see SideScanImage. In beside the ping: `altitude`, of an altimeter. */
class SideScanImageTask final : public PictureTask {
public:
    using PictureTask::PictureTask;

    framework::Properties<SideScanPictureConfig> config{this};
    framework::InputPort<types::Range> altitude{this, "altitude", "height above the bottom, the newest counts",
                                                framework::Need::Optional};

private:
    const PictureConfig& pictureConfig() const override { return *config; }
    std::unique_ptr<Painter> makePainter() override {
        auto painter = std::make_unique<SideScanImage>(*config);
        painter_ = painter.get();
        return painter;
    }
    void updateHook() override {
        types::Range measured;
        if (altitude.connected() && altitude.readNewest(measured) == framework::FlowStatus::NewData)
            painter_->setAltitude(measured.range);
        PictureTask::updateHook();
    }

    SideScanImage* painter_ = nullptr;
};

}  // namespace insonify::output
