#pragma once
#include "components/output/pictures/TruthImage.hpp"
#include "components/output/tasks/PairPictureTask.hpp"

namespace insonify::output {

struct TruthImageConfig : PairConfig {
    TruthImageConfig() { colour_map = ColourMap::Gray; }
};

/** Shows pings as fans, next to the same fans coloured by object: see TruthImage.
 *
 *  In: `ping`, from the sonar or a later task; `truth`, of the same sonar. Each ping is shown with the truth of its
 *  time. A ping whose truth is missing after `timeout`, or when the task stops, is omitted, which notices() reports. A
 *  ping and a truth that differ in beams or bins end the task in Exception. Out: `image`, both pictures side by side,
 *  at the ping's time. */
class TruthImageTask final : public PairPictureTask<TruthImageConfig, TruthImage> {
public:
    using PairPictureTask::PairPictureTask;

    framework::InputPort<types::SonarTruthPtr> truth{this, "truth", "objects in the pings' bins"};

    types::Notices notices() const override;

private:
    bool startHook() override;
    void stopHook() override;
    void show(const types::Sonar& sample);

    types::SonarTruthPtr last_;
    uint64_t omitted_ = 0;  ///< Number of pings [1].

    framework::AlignedPort<types::SonarTruthPtr> truths_{
        aligner_, truth, [this](const types::SonarTruthPtr& sample) { last_ = sample; }, 16};
    framework::AlignedPort<types::SonarPtr> pings_{aligner_, ping,
                                                   [this](const types::SonarPtr& sample) { show(*sample); }, 16};
};

}  // namespace insonify::output
