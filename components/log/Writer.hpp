#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "components/log/Reader.hpp"
#include "components/log/Stream.hpp"
#include "components/ros/Options.hpp"
#include "types/text/RosNames.hpp"

namespace insonify::log {

/** A log of either format that is being written.
 *
 *      const auto log = createLog("harbour.0.log");
 *      const size_t ping = log->addStream<types::Sonar>("sonar.ping");
 *      log->write(ping, received, sample);
 *
 *  Samples are collected in memory and written by flush(), close(), or after each megabyte. A failed write throws
 *  std::runtime_error with the system's reason; earlier flushed samples stay intact. After a failure the writer accepts
 *  no sample until next(), and kept() is the number of samples in files. For one thread. */
class Writer {
public:
    /** Closes a log with samples, and ignores a failure. One without samples that was neither flushed nor closed leaves
     *  its file as it was before, or no file. */
    virtual ~Writer() = default;

    /** Declares a stream "task.port" of T and returns its number. Throws std::length_error for the 65537th stream. */
    template <class T>
    size_t addStream(const std::string& name, const Metadata& metadata = {}) {
        return add(types::sampleIndex<T>(), name, metadata);
    }
    /** The same for the type with an index in types::SampleTypes. */
    virtual size_t add(size_t sample, const std::string& name, const Metadata& metadata) = 0;
    /** Adds a sample, received at this time. Throws std::runtime_error for a sample that the format cannot store. */
    template <class T>
    void write(size_t stream, types::Time received, const T& sample) {
        put(stream, received, received, types::SampleView(&sample));
    }
    /** @param time when the sample was true, if it has no stamp */
    virtual void put(size_t stream, types::Time received, types::Time time, types::SampleView sample) = 0;

    /** Declares a stream as in another log: with its whole declaration if both logs have one format, else by its
     *  samples' type; with `more` metadata of new keys. Throws ConfigError for a type that the format cannot store. */
    virtual size_t addLike(const Reader& log, size_t stream, const Metadata& more = {}) = 0;
    /** Adds a sample of such a stream: byte for byte if both logs have one format, else converted. */
    virtual void copy(size_t stream, Reader& log, const SampleRef& at) = 0;

    virtual void flush() = 0;  ///< Passes all samples to the system: they survive the end of this process.
    /** Flushes, and waits until the samples are on the disk: they survive a power failure. The end of a file that has
     *  been synced is synced as well. */
    virtual void sync() = 0;
    virtual void close() = 0;  ///< Flushes and ends the file. Nothing may be written afterwards.
    /** Closes and continues in another file, with the same streams. After a failed write, omits the samples that were
     *  not flushed; may be repeated if next() itself has failed. Throws as createLog and close(). */
    virtual void next(std::filesystem::path path) = 0;
    virtual bool isOpen() const = 0;  ///< False after a failed write.
    virtual const std::filesystem::path& path() const = 0;
    virtual uint64_t size() const = 0;  ///< Size of the file, including unflushed samples [B].
    virtual uint64_t kept() const = 0;  ///< Samples that were flushed, in all files [1].
};

/** Settings of one stream's messages that differ from the defaults. */
struct McapStream {
    std::optional<std::string> topic, frame_id, child_frame_id;

    static void describe(auto& self, auto& visit) {
        visit({"topic", "", "as in ROS, /auv/sonar; absent: /task/port"}, self.topic);
        visit({"frame_id", "", "of its messages; absent: the sonar's, or the frame in the poses"}, self.frame_id);
        visit({"child_frame_id", "", "the body of an Odometry; absent: the body in its pose"}, self.child_frame_id);
    }
};

/** How samples become messages in an MCAP file; by default as dds::PublisherTask sends them. */
struct McapConfig : ros::MessageOptions {
    bool transforms = true;
    std::map<std::string, McapStream> streams;  ///< By name, "task.port".
    types::RosNames names;                      ///< Namespace and frame prefix of the deployment; not a key.
    bool is_bag = true;                         ///< False: without metadata.yaml; not a key.

    static void describe(auto& self, auto& visit) {
        MessageOptions::describe(self, visit);
        visit({"transforms", "",
               "/tf from poses, /tf_static from the mounts of the pings' sonars, /clock from the stamps of "
               "both"},
              self.transforms);
        visit({"streams", "", "topics and frames of single streams, by the stream's name: task.port"}, self.streams);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Creates a log, or takes the name of one, which is emptied when the first bytes are written; the name decides the
 *  format, *.mcap or pocolog. Throws ConfigError when this fails or a Writer of any process has it open. */
std::unique_ptr<Writer> createLog(const std::filesystem::path& path, const McapConfig& mcap = {});

/** Whether the folder of a new MCAP file has the metadata.yaml of another bag, so that createLog() would refuse it. */
bool isBesideAnotherBag(const std::filesystem::path& log);

}  // namespace insonify::log
