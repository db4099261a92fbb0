#pragma once
#include <optional>

#include "components/output/maps/ScanMosaic.hpp"
#include "components/output/tasks/PairPictureTask.hpp"
#include "types/geometry/Mount.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::output {

struct MosaicConfig : PairConfig {
    types::Mount mount;

    static void describe(auto& self, auto& visit) {
        PairConfig::describe(self, visit);
        visit({"mount", "", "the sonar in the body"}, self.mount);
    }
};

/** Shows the pings of a moving scanning sonar on a disc, and next to it on a map: see ScanMosaic.
 *
 *  In: `pose`, body in the world, at its own rate; `ping`. Each ping waits for the next pose and is shown at the
 *  interpolated pose. If the previous or the next pose is missing after `timeout`, or when the task stops, the other
 *  pose is used. The picture and notices() report the number of these pings and the max time to the pose. A pose that
 *  is not finite is ignored. The map omits a ping without a pose, or at a pose that it cannot show; these are reported
 *  too. Out: `image`, both pictures side by side, at the ping's time. */
class ScanMosaicTask final : public PairPictureTask<MosaicConfig, ScanMosaic> {
public:
    using PairPictureTask::PairPictureTask;

    framework::InputPort<types::Pose> pose{this, "pose", "body in the world: x north, y west, z up"};

    types::Notices notices() const override;

private:
    bool startHook() override;
    void keep(const types::Pose& body);
    void show(const types::Sonar& sample);
    /** Returns the body's pose at a time between the previous and the next pose. */
    std::optional<types::Pose> bodyAt(types::Time time);
    types::Pose held(const types::Pose& nearest, types::Time time);
    /** Describes the map and its defects; reuses the text's memory. */
    void describeMap(std::string& text) const;

    std::string caption_;
    std::optional<types::Pose> before_;
    uint64_t laid_ = 0, held_ = 0, omitted_ = 0;
    double held_for_ = 0;  ///< Max time to a pose that was used without interpolation [s].

    framework::AlignedPort<types::Pose> poses_{aligner_, pose, [this](const types::Pose& body) { keep(body); }};
    framework::AlignedPort<types::SonarPtr> pings_{aligner_, ping,
                                                   [this](const types::SonarPtr& sample) { show(*sample); }};
};

}  // namespace insonify::output
