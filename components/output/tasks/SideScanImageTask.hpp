#pragma once
#include <deque>
#include <optional>

#include "components/framework/Graph.hpp"
#include "components/output/pictures/SideScanImage.hpp"
#include "components/output/tasks/PictureTask.hpp"

namespace insonify::output {

/** Shows the pings of a side-scan sonar: see SideScanImage. In, in addition to the ping: `altitude`, of an altimeter. A
 *  ping uses the last altitude that is not later than it, else the first altitude received. */
class SideScanImageTask final : public PictureTask {
public:
    using PictureTask::PictureTask;

    framework::Properties<SideScanPictureConfig> config{this};
    framework::InputPort<types::Range> altitude{this, "altitude", "height above the bottom, the newest is used",
                                                framework::Need::Optional};

private:
    const PictureConfig& pictureConfig() const override { return *config; }
    std::unique_ptr<Painter> makePainter() override {
        auto painter = std::make_unique<SideScanImage>(*config);
        painter_ = painter.get();
        altitudes_.clear();
        known_changes_.reset();
        return painter;
    }
    void updateHook() override {
        keepAltitudes();
        types::SonarPtr sample;
        if (!ping.readNew(sample)) return;
        while (altitudes_.size() > 1 && altitudes_[1].time <= sample->time) altitudes_.pop_front();
        if (!altitudes_.empty()) painter_->setAltitude(altitudes_.front().range);
        if (const uint64_t changes = *environment().record_changes; changes != known_changes_) {
            known_changes_ = changes;
            painter_->setReturns(framework::upstreamReturnRules(ping, types::left_receiver));
        }
        take(*sample);
    }
    void keepAltitudes() {
        constexpr size_t max_kept = 1024;
        for (types::Range measured; altitude.connected() && altitude.readNew(measured);) {
            const bool is_back = !altitudes_.empty() && measured.time < altitudes_.back().time;  // a replayed log
            if (is_back) altitudes_.clear();
            if (altitudes_.size() == max_kept) altitudes_.pop_front();
            altitudes_.push_back(measured);
        }
    }

    SideScanImage* painter_ = nullptr;
    std::optional<uint64_t> known_changes_;  ///< Of the tasks' records, when the sonar's bins were last asked for.
    std::deque<types::Range> altitudes_;     ///< The altitude in use, and later altitudes.
};

}  // namespace insonify::output
