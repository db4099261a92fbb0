#pragma once
#include <memory>

#include "components/framework/TaskContext.hpp"
#include "components/output/PictureWriter.hpp"

namespace insonify::output {

/** A task that writes its pictures to files.
 *
 *  Files are numbered by picture from 0 at each start, and written by a thread of their own. One that cannot be written
 *  ends the task in Exception; in realtime it is RunTimeError until one can be written again, and the pictures between
 *  are counted. */
class RecordingTask : public framework::TaskContext {
public:
    using TaskContext::TaskContext;
    std::vector<std::string> notices() const override { return health_.notices(); }

protected:
    /** Loads what the files of a configuration need, so that a run without it does not begin: in configureHook. Throws
     *  types::ConfigError at the property. */
    void prepareFiles(const RecordingConfig& config) const;
    /** Opens the files of a configuration, if it names any: in startHook. */
    void openFiles(const RecordingConfig& config);
    bool hasFiles() const { return writer_ != nullptr; }
    /** Leaves out the next picture's number. */
    void skipFile();
    void writeFile(const types::ImagePtr& picture);
    /** Takes over how the writer fares: once a cycle. */
    void followFiles();
    void stopHook() override;
    void errorHook() override { updateHook(); }

private:
    std::unique_ptr<PictureWriter> writer_;
    PictureHealth health_;  ///< At the last followFiles().
};

}  // namespace insonify::output
