#pragma once
#include <fmt/format.h>

#include <memory>

#include "components/framework/execution/StreamAligner.hpp"
#include "components/output/tasks/PictureTask.hpp"

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

}  // namespace insonify::output
