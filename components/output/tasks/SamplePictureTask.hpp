#pragma once
#include <memory>
#include <optional>
#include <type_traits>

#include "components/framework/Port.hpp"
#include "components/framework/Properties.hpp"
#include "components/framework/SamplePool.hpp"
#include "components/framework/TaskContext.hpp"
#include "components/output/PictureWriter.hpp"
#include "components/output/maps/SoundingMap.hpp"
#include "components/output/pictures/RangeImage.hpp"
#include "components/output/tasks/PictureConfig.hpp"

namespace insonify::output {

/** Base of tasks that write pictures to files.
 *
 *  Files are numbered from 0 at each start and written on a separate thread. A picture that cannot be written ends the
 *  task in Exception. In realtime the state is RunTimeError until a picture can be written again, and lost pictures are
 *  counted. */
class RecordingTask : public framework::TaskContext {
public:
    using TaskContext::TaskContext;
    types::Notices notices() const override { return health_.notices(); }

protected:
    /** Loads the libraries that a configuration's files need, so that a run does not begin without them: in
     *  configureHook. Throws types::ConfigError at the property. */
    void prepareFiles(const RecordingConfig& config) const;
    /** Opens the files of a configuration, if it names any: in startHook. */
    void openFiles(const RecordingConfig& config);
    bool hasFiles() const { return writer_ != nullptr; }
    /** Skips a picture's number. */
    void skipFile();
    void writeFile(const types::ImagePtr& picture);
    /** Takes over the writer's state; once a cycle. */
    void followFiles();
    void stopHook() override;
    void errorHook() override { updateHook(); }

private:
    std::unique_ptr<PictureWriter> writer_;
    PictureHealth health_;  ///< State at the last followFiles().
};

struct SamplePictureConfig : RecordingConfig {
    uint32_t every = 1;
    uint32_t width = 1024;
    ColourMap colour_map = ColourMap::Turbo;

    static void describe(auto& self, auto& visit) {
        RecordingConfig::describe(self, visit);
        visit({"every", "1", "samples from one picture to the next, and in the first", 1, 1e6}, self.every);
        visit({"width", "1", "width of the picture in pixels; an odd width is rounded up to even; the height follows",
               256, 8192},
              self.width);
        visit({"colour_map", "", "colours from the deepest to the highest, or from the farthest to the nearest"},
              self.colour_map);
    }
};

struct SoundingMapConfig : SamplePictureConfig {
    std::optional<types::Datum> datum = {};

    static void describe(auto& self, auto& visit) {
        SamplePictureConfig::describe(self, visit);
        visit({"datum", "", "the world's origin on the earth, named in the title; absent: the deployment's"},
              self.datum);
    }
};

/** Shows samples that are not pings, with a Picture.
 *
 *  In: a port named by Picture::port. Out: `image` and files, as in PictureTask; the first picture is made after
 *  `every` samples. */
template <class Picture>
class SamplePictureTask final : public RecordingTask {
public:
    using RecordingTask::RecordingTask;
    using Sample = typename Picture::Sample;

    using Config = std::conditional_t<std::is_same_v<Picture, SoundingMap>, SoundingMapConfig, SamplePictureConfig>;

    framework::Properties<Config> config{this};
    framework::InputPort<Sample> input{this, Picture::port, "samples to show"};
    framework::OutputPort<types::ImagePtr> image{this, "image", "picture, BGR with 8 bits a channel"};

private:
    bool configureHook() override;
    bool startHook() override;
    void updateHook() override;
    void show();

    std::unique_ptr<Picture> picture_;
    framework::SamplePool<types::Image> pool_;
    uint64_t samples_ = 0;
};

using SoundingMapTask = SamplePictureTask<SoundingMap>;
using RangeImageTask = SamplePictureTask<RangeImage>;

}  // namespace insonify::output
