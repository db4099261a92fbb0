#pragma once
#include <fmt/format.h>

#include <memory>

#include "components/framework/StreamAligner.hpp"
#include "components/output/PictureTask.hpp"

namespace insonify::output {

/** Of two pictures beside each other, for which a ping waits for a sample of another port. */
struct PairConfig : PictureConfig {
    double timeout = 1;

    PairConfig() { width = 2048; }

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        PictureConfig::describe(self, visit);
        visit(types::Field{"timeout", "s", "that a ping waits for the sample that belongs to it, in the samples' time",
                           0, 1e6},
              self.timeout);
    }
    /** As for any pictures; the two together are at least twice as wide as one. */
    void check(types::Diagnostics& diagnostics) const {
        PictureConfig::check(diagnostics);
        if (width < 512)
            diagnostics.push_back({"width", fmt::format("is {} px; two pictures side by side take 512", width)});
    }
};

/** What the tasks have in common that show a ping beside what a sample of another port says of it. */
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
    framework::StreamAligner aligner_;  ///< Of the ports of who derives.

private:
    const PictureConfig& pictureConfig() const override { return *config; }
    std::unique_ptr<Painter> makePainter() override {
        auto picture = std::make_unique<Picture>(*config);
        picture_ = picture.get();
        return picture;
    }
};

}  // namespace insonify::output
