#pragma once
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "components/output/PictureFiles.hpp"
#include "types/text/Notice.hpp"

namespace insonify::output {

/** What a writer does if a picture cannot be written. */
enum class AtPictureFailure {
    Throw,  ///< Stops writing, and throws.
    Count   ///< Counts the picture, and tries the next.
};

/** The state of a writer that counts. */
struct PictureHealth {
    uint64_t lost = 0;    ///< Pictures that are in no file [1].
    bool fails = false;   ///< Whether the last picture could not be written.
    std::string failure;  ///< The last reason.

    /** Returns a warning if pictures are lost. */
    types::Notices notices() const;
};

/** Writes pictures to files on a separate thread. The queue is short; when it is full, the caller waits, so no picture
 *  is lost. */
class PictureWriter {
public:
    /** `queue`: max pictures that wait, beside the one that is being written [1]. */
    explicit PictureWriter(PictureFiles files, AtPictureFailure at_failure = AtPictureFailure::Throw, size_t queue = 4);
    /** Writes the queue; errors are no longer reported. */
    ~PictureWriter();
    PictureWriter(const PictureWriter&) = delete;
    PictureWriter& operator=(const PictureWriter&) = delete;

    /** Keeps the picture until it is written. Throws the error of an earlier picture. */
    void write(types::ImagePtr picture);
    /** Skips a picture's number; before the first write(). */
    void skip();
    /** Writes the queue and ends the files. Throws the error of any picture. */
    void close();
    PictureHealth health();

private:
    void loop();
    /** Writes a picture; null ends the files. */
    void put(const types::Image* picture);
    void end();

    PictureFiles files_;
    AtPictureFailure at_failure_;
    PictureHealth health_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<types::ImagePtr> waiting_;
    size_t first_ = 0, count_ = 0;
    bool ending_ = false;
    std::exception_ptr error_;
    std::thread thread_;
};

}  // namespace insonify::output
