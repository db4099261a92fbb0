#pragma once
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "components/framework/execution/StreamAligner.hpp"
#include "components/output/maps/ScanMosaic.hpp"
#include "components/output/pictures/TruthImage.hpp"
#include "components/output/tasks/PictureTask.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::output {

/** Properties of tasks that show two pictures side by side: a ping waits for a sample of another port. */
struct PairConfig : PictureConfig {
    double timeout = 1;

    PairConfig() { width = 2048; }

    static void describe(auto& self, auto& visit) {
        PictureConfig::describe(self, visit);
        visit({"timeout", "s", "max wait of a ping for its matching sample, in the samples' time", 0, 1e6},
              self.timeout);
    }
    /** Checks also that both pictures together have at least twice the min width. */
    void check(types::Diagnostics& diagnostics) const {
        PictureConfig::check(diagnostics);
        if (width < 512)
            diagnostics.push_back({"width", fmt::format("is {} px; two pictures side by side take 512", width)});
    }
};

/** Base of tasks that show a ping next to a picture made with a sample of another port. */
template <class Config, class Picture>
class PairPictureTask : public PictureTask {
public:
    using PictureTask::PictureTask;

    framework::Properties<Config> config{this};

protected:
    bool startHook() override {
        aligner_.clear(config->timeout);
        return PictureTask::startHook();
    }
    void updateHook() override { aligner_.update(); }
    void stopHook() override {
        aligner_.flush();
        PictureTask::stopHook();
    }

    Picture* picture_ = nullptr;        ///< The painter.
    framework::StreamAligner aligner_;  ///< Aligns the ports of the derived class.

private:
    const PictureConfig& pictureConfig() const override { return *config; }
    std::unique_ptr<Painter> makePainter() override {
        auto picture = std::make_unique<Picture>(*config);
        picture_ = picture.get();
        return picture;
    }
};

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
