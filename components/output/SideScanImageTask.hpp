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
    std::unique_ptr<Painter> makePainter() override;
    void updateHook() override;

    SideScanImage* painter_ = nullptr;
};

}  // namespace insonify::output
