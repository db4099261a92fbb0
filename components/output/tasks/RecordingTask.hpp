#pragma once
#include <memory>

#include "components/framework/TaskContext.hpp"
#include "components/output/PictureWriter.hpp"

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

}  // namespace insonify::output
