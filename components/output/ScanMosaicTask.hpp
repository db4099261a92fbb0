#pragma once
#include <optional>

#include "components/output/PairPictureTask.hpp"
#include "components/output/ScanMosaic.hpp"
#include "types/Mount.hpp"
#include "types/Pose.hpp"

namespace insonify::output {

struct MosaicConfig : PairConfig {
    types::Mount mount;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        PairConfig::describe(self, visit);
        visit(types::Field{"mount", "", "the sonar in the body"}, self.mount);
    }
};

/** Shows the pings of a moving scanning sonar as they were heard, and beside that where they belong: see ScanMosaic.
 *
 *  In: `pose`, body in the world, at its own rate; `ping`. Each ping is laid at the pose interpolated between the pose
 *  before it and the one after it, which it waits for. Where one of the two does not come within `timeout`, or before
 *  the task stops, the ping is laid at the other one: the picture and notices() tell how many and how far off in time.
 *  A pose that is not finite is none. A ping without any pose, or with one that the map cannot show, is left out of it,
 *  which is told as well.
 *  Out: `image`, both pictures side by side, at the ping's time. */
class ScanMosaicTask final : public PairPictureTask<MosaicConfig, ScanMosaic> {
public:
    using PairPictureTask::PairPictureTask;

    framework::InputPort<types::Pose> pose{this, "pose", "body in the world: x north, y west, z up"};

    std::vector<std::string> notices() const override;

private:
    bool startHook() override;
    void keep(const types::Pose& body);
    void show(const types::Sonar& sample);
    /** The body at a time between the pose before and the one after it. */
    std::optional<types::Pose> bodyAt(types::Time time);
    types::Pose held(const types::Pose& nearest, types::Time time);
    /** How the map has come about, and what is amiss with it; keeps the text's memory. */
    void describeMap(std::string& text) const;

    std::string caption_;
    std::optional<types::Pose> before_;
    uint64_t laid_ = 0, held_ = 0, left_out_ = 0;
    double held_for_ = 0;  ///< The longest time to a pose that was held [s].

    framework::AlignedPort<types::Pose> poses_{aligner_, pose, [this](const types::Pose& body) { keep(body); }};
    framework::AlignedPort<types::SonarPtr> pings_{aligner_, ping,
                                                   [this](const types::SonarPtr& sample) { show(*sample); }};
};

}  // namespace insonify::output
