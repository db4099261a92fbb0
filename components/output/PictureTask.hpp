#pragma once
#include <memory>

#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/output/Painter.hpp"
#include "components/output/PictureConfig.hpp"
#include "components/output/PictureWriter.hpp"
#include "types/Image.hpp"
#include "types/Sonar.hpp"

namespace insonify::output {

/** What the tasks that show pings have in common: ping in, picture out, on a port and in files.
 *
 *  A picture is made only when somebody is connected to `image` or a file is configured, and of one ping in `every`;
 *  it carries the ping's time. Files are numbered by picture from 0 at each start, and written by a thread of their
 *  own; one that cannot be written ends the task in Exception. */
class PictureTask : public framework::TaskContext {
public:
    using TaskContext::TaskContext;

    framework::Properties<PictureConfig> config{this};
    framework::InputPort<types::SonarPtr> ping{this, "ping", "what is shown"};
    framework::OutputPort<types::ImagePtr> image{this, "image", "picture, BGR with 8 bits a channel"};

protected:
    virtual std::unique_ptr<Painter> makePainter(const DisplayConfig& display) const = 0;

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void stopHook() override;
    void cleanupHook() override;
    void show(const types::Sonar& sample);

    std::unique_ptr<Painter> painter_;
    std::unique_ptr<PictureWriter> writer_;
    framework::SamplePool<types::Image> pool_;
    uint64_t pings_ = 0;
};

/** Shows the pings of a forward-looking sonar as fans: see FanImage. */
class FanImageTask final : public PictureTask {
public:
    using PictureTask::PictureTask;

private:
    std::unique_ptr<Painter> makePainter(const DisplayConfig& display) const override;
};

/** Shows the pings of a mechanically scanning sonar on a disc: see DiscImage. */
class DiscImageTask final : public PictureTask {
public:
    using PictureTask::PictureTask;

private:
    std::unique_ptr<Painter> makePainter(const DisplayConfig& display) const override;
};

/** Shows range against time: see WaterfallImage. */
class WaterfallImageTask final : public PictureTask {
public:
    using PictureTask::PictureTask;

private:
    std::unique_ptr<Painter> makePainter(const DisplayConfig& display) const override;
};

}  // namespace insonify::output
