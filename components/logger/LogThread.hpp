#pragma once
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "components/log/Writer.hpp"
#include "components/logger/LoggerConfig.hpp"
#include "types/samples/DeploymentControl.hpp"

namespace insonify::logger {

/** Throws ConfigError when another logger writes one of the files that removeSequels() removes. */
void refuseSequels(const std::filesystem::path& log);

/** Removes the files that follow `log` from an earlier run, also after missing numbers, because Rock would read them as
 *  parts of this run. Call it when the run starts: until then, it may still fail. Throws as refuseSequels(), when
 * another logger writes the last of them, before removing any. */
void removeSequels(const std::filesystem::path& log);

/** Decides when a log continues in its next file: x.0.log, x.1.log... */
class Rotation {
public:
    Rotation(const LoggerConfig& config, log::Writer& log);

    /** Continues in the next file if this one is full or old enough, or the clock was set back to before its start,
     *  before a sample received at `now`. Throws as log::Writer::next. */
    void before(types::Time now);

private:
    bool due(types::Time now) const;
    /** Removes the oldest files of the run, so that all of them with the next one are at most `max_total_size`. */
    void removeOldest() const;

    log::Writer& log_;
    std::optional<double> max_size_, max_duration_, max_total_;
    unsigned first_;                    ///< Number of the run's first file.
    std::optional<types::Time> began_;  ///< When the file's first sample was received.
};

/** The behaviour of a log whose file cannot be written: it throws, or drops samples and continues in another file as
 *  soon as that can be written. */
enum class AtFailure { Throw, Heal };

/** The state of a log that heals. */
struct LogHealth {
    uint64_t outages = 0;        ///< Times that the file could not be written.
    uint64_t lost = 0;           ///< Samples of past outages.
    uint64_t refused = 0;        ///< Samples that the format cannot store.
    bool fails = false;          ///< There is an outage.
    std::string failure;         ///< The reason of the last outage or refusal.
    std::filesystem::path file;  ///< The file in which the log continued after the last outage.
};

/** What a log has written so far, for threads that ask. Thread-safe. */
class RecordingBoard {
public:
    void set(const types::Recording& recording) {
        const std::lock_guard lock(mutex_);
        recording_ = recording;
    }
    std::optional<types::Recording> get() const {
        const std::lock_guard lock(mutex_);
        return recording_;
    }

private:
    mutable std::mutex mutex_;
    std::optional<types::Recording> recording_;
};

/** Returns the size of a recording, with the space left on the disk of its present file. */
types::Recording reportOn(const std::filesystem::path& file, uint64_t bytes);

/** Declares a stream. */
using Declare = std::function<size_t(log::Writer&)>;

/** Writes samples to a log on its own thread, in the order of push(), and flushes in between.
 *
 *  A ring of fixed size is between push() and the file, with at most max_bytes of samples. If the file is slower than
 *  the samples for long, push() waits for space. An error of the file is thrown once, by the next push() or by
 *  finish(), with the number of pushed samples that are not in the file. With AtFailure::Heal, samples are dropped
 *  instead until the log can continue in its next file, x.1.log after x.0.log, which is tried each second. finish()
 *  throws if this does not succeed until the end. */
class LogThread {
public:
    static constexpr size_t max_bytes = size_t{256} << 20;  ///< Of waiting samples, apart from one of any size [B].

    /** Until finish(), `log` and `rotation` are used only by the thread. Flushes every `flush_period` and syncs every
     *  `sync_period` [s]; `capacity` is above 0. What is written is reported to `board`, if there is one, at most four
     *  times a second. */
    LogThread(log::Writer& log, Rotation& rotation, size_t capacity, double flush_period,
              AtFailure at_failure = AtFailure::Throw, double sync_period = 1e9, RecordingBoard* board = nullptr);
    ~LogThread();
    LogThread(const LogThread&) = delete;
    LogThread& operator=(const LogThread&) = delete;

    /** Adds a sample of a stream, received at that time. Throws std::runtime_error once the file has failed. */
    void push(size_t stream, types::Time received, auto sample) {
        const size_t bytes = toBytes(*types::carriedSample(sample));
        Entry& entry = freeEntry(bytes);
        entry.stream = stream;
        entry.bytes = bytes;
        entry.received = received;
        entry.sample = std::move(sample);
        ++pushed_;
        commit();
    }
    /** Declares a stream before the samples that are pushed later. Throws as push(). */
    void declare(Declare declaration);
    /** Writes and flushes the waiting samples, and ends the thread. Throws std::runtime_error if the file has failed
     *  and push() has not thrown. */
    void finish();
    LogHealth health() const;

private:
    struct Entry {
        size_t stream = 0;
        types::Time received;
        types::AnySample sample;
        size_t bytes = 0;     ///< Size of the sample in memory [B].
        Declare declaration;  ///< Instead of a sample.
    };
    using Clock = std::chrono::steady_clock;

    /** Returns the size of a sample in memory, without that of texts in lists [B]. */
    template <class T>
    static size_t toBytes(const T& sample) {
        size_t bytes = sizeof(T);
        if constexpr (types::Described<T>) {
            const auto add = [&]<class Value>(const types::Field&, const Value& value) {
                if constexpr (requires { value.size() * sizeof(typename Value::value_type); })
                    bytes += value.size() * sizeof(typename Value::value_type);
            };
            T::describe(sample, add);
        }
        return bytes;
    }
    /** Waits until there is room for an entry of this size. */
    Entry& freeEntry(size_t bytes = 0);
    void commit();
    void run();
    void writeAll();
    void write(Entry& entry);
    void work(Entry* entry);    ///< One iteration of the thread: an entry, if there is one, and due flushes.
    void flush();               ///< Also syncs, if that is due.
    void pass(Entry& entry);    ///< Releases a sample, written or lost; a stream waits for the next file.
    void report(bool at_once);  ///< Reports what was written, if that is due.
    void refuse(Entry& entry, const std::string& why);
    void beginOutage(const std::string& why);
    void tryAgain();
    [[noreturn]] void reportFailure();

    log::Writer& log_;
    Rotation& rotation_;
    const uint64_t kept_before_;  ///< Samples in the log when the thread began.
    uint64_t pushed_ = 0;
    std::chrono::nanoseconds flush_period_, sync_period_;
    const AtFailure at_failure_;
    uint64_t handed_ = 0;           ///< Samples for the file so far, including lost samples.
    uint64_t kept_at_opening_ = 0;  ///< Samples in files when the present file was opened.
    std::vector<Declare> pending_;  ///< Streams declared in an outage.
    std::filesystem::path opened_;  ///< The last file that could be opened.
    std::filesystem::path sequel_;  ///< The log's next file.
    Clock::time_point next_try_, next_flush_, next_sync_;
    LogHealth health_;  ///< Changed by the thread, under the mutex.
    RecordingBoard* const board_;
    types::Recording written_;    ///< So far.
    uint64_t present_bytes_ = 0;  ///< Those of `written_.bytes` that are in the present file [B].
    Clock::time_point next_report_;
    mutable std::mutex mutex_;
    std::condition_variable work_, room_;
    std::vector<Entry> ring_;
    size_t waiting_bytes_ = 0;      ///< Size of the waiting samples [B].
    size_t first_ = 0, count_ = 0;  ///< The thread owns ring_[first_] while count_ > 0; push() the entries after them.
    bool ending_ = false;
    bool failed_ = false;
    std::string failure_;  ///< Not thrown yet.
    uint64_t kept_ = 0;    ///< Samples in the log when it failed.
    std::thread thread_;
};

}  // namespace insonify::logger
