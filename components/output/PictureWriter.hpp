#pragma once
#include <array>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "components/output/PictureFiles.hpp"

namespace insonify::output {

/** Writes pictures to files on a thread of its own. A few may wait; then the giver waits too, so none is lost. */
class PictureWriter {
public:
    explicit PictureWriter(PictureFiles files);
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

private:
    void loop();
    void end();

    PictureFiles files_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::array<types::ImagePtr, 4> waiting_;
    size_t first_ = 0, count_ = 0;
    bool ending_ = false;
    std::exception_ptr error_;
    std::thread thread_;
};

}  // namespace insonify::output
