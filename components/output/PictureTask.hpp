#pragma once
#include <memory>
#include <type_traits>

#include "components/framework/Offers.hpp"
#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/Registry.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/output/DiscImage.hpp"
#include "components/output/FanImage.hpp"
#include "components/output/Painter.hpp"
#include "components/output/PictureConfig.hpp"
#include "components/output/RecordingTask.hpp"
#include "components/output/WaterfallImage.hpp"
#include "types/Image.hpp"
#include "types/Sonar.hpp"

namespace insonify::output {

/** What the tasks that show pings have in common: ping in, picture out, on a port and in files.
 *
 *  A picture is made only when somebody is connected to `image` or a file is configured, and of one ping in `every`;
 *  it carries the ping's time. */
class PictureTask : public RecordingTask, public framework::Divisible {
public:
    using RecordingTask::RecordingTask;

    framework::InputPort<types::SonarPtr> ping{this, "ping", "what is shown"};
    framework::OutputPort<types::ImagePtr> image{this, "image", "picture, BGR with 8 bits a channel"};

    std::string indivisible() const override;

protected:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void cleanupHook() override;
    /** Makes the picture of a ping, or lets the painter take note of it. */
    void take(const types::Sonar& sample);

private:
    virtual const PictureConfig& pictureConfig() const = 0;
    virtual std::unique_ptr<Painter> makePainter() = 0;
    /** Whether a picture shows its own ping alone. */
    virtual bool showsOne() const { return false; }
    void show(const types::Sonar& sample);
    void paint(const types::Sonar& sample, types::Image& picture);

    std::unique_ptr<Painter> painter_;
    framework::SamplePool<types::Image> pool_;
    uint64_t pings_ = 0;
};

/** Shows pings as the Picture does, which is a Painter that needs nothing but them. */
template <class Picture>
class PingPictureTask final : public PictureTask {
public:
    using PictureTask::PictureTask;
    framework::Properties<PictureConfig> config{this};

private:
    const PictureConfig& pictureConfig() const override { return *config; }
    std::unique_ptr<Painter> makePainter() override { return std::make_unique<Picture>(*config); }
    bool showsOne() const override { return std::is_same_v<Picture, FanImage>; }
};

using FanImageTask = PingPictureTask<FanImage>;
using DiscImageTask = PingPictureTask<DiscImage>;
using WaterfallImageTask = PingPictureTask<WaterfallImage>;

/** Makes the tasks of this folder known to deployments. */
void registerTasks(framework::Registry& registry);

}  // namespace insonify::output
