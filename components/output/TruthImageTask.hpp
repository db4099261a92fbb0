#pragma once
#include <memory>

#include "components/framework/StreamAligner.hpp"
#include "components/output/PictureTask.hpp"
#include "components/output/TruthImage.hpp"

namespace insonify::output {

struct TruthImageConfig : PictureConfig {
    double timeout = 1;

    TruthImageConfig() {
        width = 2048;
        colour_map = ColourMap::Gray;
    }

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        PictureConfig::describe(self, visit);
        visit(types::Field{"timeout", "s", "that a ping waits for its truth, in the samples' time", 0, 1e6},
              self.timeout);
    }
    /** As for any pictures; the two together are at least twice as wide as one. */
    void check(types::Diagnostics& diagnostics) const;
};

/** Shows pings as fans, and beside each the same fan with what its bins show: see TruthImage.
 *
 *  In: `ping`, as it left the sonar or what came after it; `truth`, of the same sonar. Each ping is shown with the
 *  truth of its time; one whose truth does not come within `timeout`, or before the task stops, is left out, which
 *  notices() tells. A ping and a truth of other beams or bins end the task in Exception.
 *  Out: `image`, both pictures side by side, at the ping's time. */
class TruthImageTask final : public PictureTask {
public:
    using PictureTask::PictureTask;

    framework::Properties<TruthImageConfig> config{this};
    framework::InputPort<types::SonarTruthPtr> truth{this, "truth", "what the pings' bins show"};

    std::vector<std::string> notices() const override;

private:
    const PictureConfig& pictureConfig() const override { return *config; }
    std::unique_ptr<Painter> makePainter() override;
    bool startHook() override;
    void updateHook() override { aligner_.update(); }
    void stopHook() override;
    void show(const types::Sonar& sample);

    TruthImage* picture_ = nullptr;  ///< The painter.
    types::SonarTruthPtr last_;
    uint64_t left_out_ = 0;  ///< Pings [1].

    framework::StreamAligner aligner_;
    framework::AlignedPort<types::SonarTruthPtr> truths_{
        aligner_, truth, [this](const types::SonarTruthPtr& sample) { last_ = sample; }, 16};
    framework::AlignedPort<types::SonarPtr> pings_{aligner_, ping,
                                                   [this](const types::SonarPtr& sample) { show(*sample); }, 16};
};

}  // namespace insonify::output
