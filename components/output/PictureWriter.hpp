#pragma once
#include <array>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "components/output/PictureFiles.hpp"

namespace insonify::output {

/** What a writer does with pictures that cannot be written. */
enum class AtPictureFailure {
    Throw,  ///< It writes no more, and throws.
    Count   ///< It counts them, and tries the next one.
};

/** How a writer that counts fares. */
struct PictureHealth {
    uint64_t lost = 0;    ///< Pictures that are in no file [1].
    bool fails = false;   ///< The last one is not.
    std::string failure;  ///< The last reason.

    /** A warning where pictures are lost. */
    std::vector<std::string> notices() const;
};

/** Writes pictures to files on a thread of its own. A few may wait; then the giver waits too, so none is lost. */
class PictureWriter {
public:
    explicit PictureWriter(PictureFiles files, AtPictureFailure at_failure = AtPictureFailure::Throw);
    /** Writes what waits; errors are not told any more. */
    ~PictureWriter();
    PictureWriter(const PictureWriter&) = delete;
    PictureWriter& operator=(const PictureWriter&) = delete;

    /** Takes hold of the picture until it is written. Throws what an earlier picture met. */
    void write(types::ImagePtr picture);
    /** Leaves out the next picture's number; before the first of write(). */
    void skip();
    /** Writes what waits and ends the files. Throws what any picture met. */
    void close();
    PictureHealth health();

private:
    void loop();
    /** Writes a picture or, without one, ends the files. */
    void put(const types::Image* picture);
    void end();

    PictureFiles files_;
    AtPictureFailure at_failure_;
    PictureHealth health_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::array<types::ImagePtr, 4> waiting_;
    size_t first_ = 0, count_ = 0;
    bool ending_ = false;
    std::exception_ptr error_;
    std::thread thread_;
};

}  // namespace insonify::output
