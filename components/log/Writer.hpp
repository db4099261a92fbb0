#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "components/log/Reader.hpp"
#include "components/log/Stream.hpp"
#include "components/ros/Options.hpp"
#include "types/RosNames.hpp"

namespace insonify::log {

/** A log of either format that is being written.
 *
 *      const auto log = createLog("harbour.0.log");
 *      const size_t ping = log->addStream<types::Sonar>("sonar.ping");
 *      log->write(ping, received, sample);
 *
 *  Samples gather in memory and go to the file with flush(), close(), or when a megabyte has come together. A write
 *  that fails throws std::runtime_error with the system's reason and leaves what was flushed before, whole. After it
 * the writer takes nothing more until next(), and kept() is the number of samples that are in files. For one thread. */
class Writer {
public:
    virtual ~Writer() = default;

    /** Declares a stream "task.port" of T and returns its number. Throws std::length_error for the 65537th stream. */
    template <class T>
    size_t addStream(const std::string& name, const Metadata& metadata = {}) {
        return add(types::sampleIndex<T>(), name, metadata);
    }
    /** The same for the type at a place of types::SampleTypes. */
    virtual size_t add(size_t sample, const std::string& name, const Metadata& metadata) = 0;
    /** Adds a sample, received at this moment. Throws std::runtime_error for one that the format cannot hold. */
    template <class T>
    void write(size_t stream, types::Time received, const T& sample) {
        put(stream, received, received, types::SampleView(&sample));
    }
    /** @param time when it was true, of one that bears no stamp. */
    virtual void put(size_t stream, types::Time received, types::Time time, types::SampleView sample) = 0;

    /** Declares a stream as another log does: with all that it declares there where both are of one format, else for
     *  its samples' type; with `more` metadata, of keys that it has not. Throws ConfigError for a type that the format
     *  cannot hold. */
    virtual size_t addLike(const Reader& log, size_t stream, const Metadata& more = {}) = 0;
    /** Adds a sample of such a stream: byte for byte where both logs are of one format, else what it says. */
    virtual void copy(size_t stream, Reader& log, const SampleRef& at) = 0;

    virtual void flush() = 0;  ///< Hands all samples to the system: they survive the end of this process.
    virtual void close() = 0;  ///< Flushes, ends the file. Nothing may be written after it.
    /** Closes and goes on in another file, with the same streams; after a write that failed without what had not been
     *  flushed, and again where next() itself has failed. Throws as createLog and close(). */
    virtual void next(std::filesystem::path path) = 0;
    virtual bool isOpen() const = 0;  ///< Not after a write that failed.
    virtual const std::filesystem::path& path() const = 0;
    virtual uint64_t size() const = 0;  ///< Of the file, with what is not flushed [B].
    virtual uint64_t kept() const = 0;  ///< Samples that were flushed, in all files [1].
};

/** What of a stream's messages is not as usual. */
struct McapStream {
    std::optional<std::string> topic, frame_id, child_frame_id;

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        using types::Field;
        visit(Field{"topic", "", "as in ROS, /auv/sonar; absent: /task/port"}, self.topic);
        visit(Field{"frame_id", "", "of its messages; absent: the sonar's, of poses what they name"}, self.frame_id);
        visit(Field{"child_frame_id", "", "the body of an Odometry; absent: what its pose names"}, self.child_frame_id);
    }
};

/** How samples become messages in an MCAP file: by default as dds::PublisherTask sends them. */
struct McapConfig : ros::MessageOptions {
    bool transforms = true;
    std::map<std::string, McapStream> streams;  ///< By name, "task.port".
    types::RosNames names;                      ///< Namespace and frame prefix of the deployment; no key.

    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        MessageOptions::describe(self, visit);
        visit(types::Field{"transforms", "",
                           "/tf from poses, /tf_static from the mounts of the pings' sonars, /clock from the stamps of "
                           "both"},
              self.transforms);
        visit(types::Field{"streams", "", "topics and frames of single streams, by the stream's name: task.port"},
              self.streams);
    }
    void check(types::Diagnostics& diagnostics) const;
};

/** Creates a log, or empties it; the format follows from the name, *.mcap or pocolog. Throws ConfigError when that
 *  cannot be done or another Writer, of this process or not, has it open. */
std::unique_ptr<Writer> createLog(const std::filesystem::path& path, const McapConfig& mcap = {});

}  // namespace insonify::log
