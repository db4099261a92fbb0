#pragma once
#include <memory>
#include <type_traits>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/output/pictures/FanImage.hpp"
#include "components/output/pictures/Painter.hpp"
#include "components/output/pictures/WaterfallImage.hpp"
#include "components/output/tasks/PictureConfig.hpp"
#include "components/output/tasks/SamplePictureTask.hpp"
#include "types/samples/Image.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::output {

/** Base of tasks that show pings: ping in, picture out, on a port and in files.
 *
 *  A picture is made only if `image` is connected or a file is configured, and for one ping in `every`: the first, or
 *  for a disc the last, when the head has turned. A run that ends before has a picture of its last ping. It has the
 *  ping's time. */
class PictureTask : public RecordingTask, public framework::Divisible {
public:
    using RecordingTask::RecordingTask;

    framework::InputPort<types::SonarPtr> ping{this, "ping", "pings to show"};
    framework::OutputPort<types::ImagePtr> image{this, "image", "picture, BGR with 8 bits a channel"};

    std::string indivisible() const override;
    void check(types::Diagnostics& diagnostics) const override;

protected:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void stopHook() override;
    void cleanupHook() override;
    /** Makes the picture of a ping, or lets the painter skip it. */
    void take(const types::Sonar& sample);

private:
    virtual const PictureConfig& pictureConfig() const = 0;
    virtual std::unique_ptr<Painter> makePainter() = 0;
    /** Returns whether a picture shows only its own ping. */
    virtual bool showsOne() const { return false; }
    /** Returns whether pictures show what a head hears while it turns. */
    virtual bool showsTurns() const { return false; }
    /** Returns whether pictures are received or written. */
    bool isWanted() const { return image.connected() || hasFiles(); }
    void show(const types::Sonar& sample);
    void paint(const types::Sonar& sample, types::Image& picture);

    std::unique_ptr<Painter> painter_;
    framework::SamplePool<types::Image> pool_;
    types::SonarPtr last_;  ///< Of a turn that has no picture yet.
    uint64_t pings_ = 0;
};

/** Shows pings with a Picture: a Painter that needs only pings. */
template <class Picture>
class PingPictureTask final : public PictureTask {
public:
    using PictureTask::PictureTask;
    framework::Properties<PictureConfig> config{this};

private:
    const PictureConfig& pictureConfig() const override { return *config; }
    std::unique_ptr<Painter> makePainter() override { return std::make_unique<Picture>(*config); }
    bool showsOne() const override { return std::is_same_v<Picture, FanImage>; }
    bool showsTurns() const override { return std::is_same_v<Picture, DiscImage>; }
};

using FanImageTask = PingPictureTask<FanImage>;
using DiscImageTask = PingPictureTask<DiscImage>;
using WaterfallImageTask = PingPictureTask<WaterfallImage>;

/** Registers the tasks of this folder for deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::output
