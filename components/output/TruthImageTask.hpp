#pragma once
#include "components/output/PairPictureTask.hpp"
#include "components/output/TruthImage.hpp"

namespace insonify::output {

struct TruthImageConfig : PairConfig {
    TruthImageConfig() { colour_map = ColourMap::Gray; }
};

/** Shows pings as fans, and beside each the same fan with what its bins show: see TruthImage.
 *
 *  In: `ping`, as it left the sonar or what came after it; `truth`, of the same sonar. Each ping is shown with the
 *  truth of its time; one whose truth does not come within `timeout`, or before the task stops, is left out, which
 *  notices() tells. A ping and a truth of other beams or bins end the task in Exception.
 *  Out: `image`, both pictures side by side, at the ping's time. */
class TruthImageTask final : public PairPictureTask<TruthImageConfig, TruthImage> {
public:
    using PairPictureTask::PairPictureTask;

    framework::InputPort<types::SonarTruthPtr> truth{this, "truth", "what the pings' bins show"};

    std::vector<std::string> notices() const override;

private:
    bool startHook() override;
    void stopHook() override;
    void show(const types::Sonar& sample);

    types::SonarTruthPtr last_;
    uint64_t left_out_ = 0;  ///< Pings [1].

    framework::AlignedPort<types::SonarTruthPtr> truths_{
        aligner_, truth, [this](const types::SonarTruthPtr& sample) { last_ = sample; }, 16};
    framework::AlignedPort<types::SonarPtr> pings_{aligner_, ping,
                                                   [this](const types::SonarPtr& sample) { show(*sample); }, 16};
};

}  // namespace insonify::output
