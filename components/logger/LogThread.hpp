#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "components/log/Writer.hpp"
#include "components/logger/Rotation.hpp"

namespace insonify::logger {

/** Declares a stream. */
using Declare = std::function<size_t(log::Writer&)>;

/** Writes samples to a log on a thread of its own, in the order in which they were pushed, and flushes in between.
 *
 *  Between push() and the file lies a ring of fixed size. Where the file is slower than the samples for long, push()
 *  waits for room. What fails with the file is thrown once, by the next push() or by finish(), with the number of
 *  samples that were pushed and are not in the file. */
class LogThread {
public:
    /** `log` and `rotation` are the thread's alone until finish(). Flushes every `flush_period` [s]; `capacity` is
     *  above 0. */
    LogThread(log::Writer& log, Rotation& rotation, size_t capacity, double flush_period);
    ~LogThread();
    LogThread(const LogThread&) = delete;
    LogThread& operator=(const LogThread&) = delete;

    /** Takes a sample of a stream, received at that time. Throws std::runtime_error once the file has failed. */
    template <class Sample>
    void push(size_t stream, types::Time received, Sample sample) {
        Entry& entry = freeEntry();
        entry.stream = stream;
        entry.received = received;
        entry.sample = std::move(sample);
        ++pushed_;
        commit();
    }
    /** Declares a stream before the samples that are pushed after it. Throws as push(). */
    void declare(Declare declaration);
    /** Writes and flushes what waits, and ends the thread. Throws std::runtime_error if the file has failed and push()
     *  has not told it. */
    void finish();

private:
    struct Entry {
        size_t stream = 0;
        types::Time received;
        types::AnySample sample;
        Declare declaration;  ///< Instead of a sample.
    };
    using Clock = std::chrono::steady_clock;

    Entry& freeEntry();
    void commit();
    void run();
    void writeAll();
    void write(Entry& entry);
    [[noreturn]] void tellFailure();

    log::Writer& log_;
    Rotation& rotation_;
    const uint64_t kept_before_;  ///< Samples that were in the log when the thread began.
    uint64_t pushed_ = 0;
    std::chrono::nanoseconds flush_period_;
    std::mutex mutex_;
    std::condition_variable work_, room_;
    std::vector<Entry> ring_;
    size_t first_ = 0, count_ = 0;  ///< The thread owns ring_[first_] while count_ > 0; push() the entries after them.
    bool ending_ = false;
    bool failed_ = false;
    std::string failure_;  ///< Not told yet.
    uint64_t kept_ = 0;    ///< Samples in the log when it failed.
    std::thread thread_;
};

}  // namespace insonify::logger
