#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/pocolog/Block.hpp"
#include "components/pocolog/Index.hpp"
#include "components/pocolog/Metadata.hpp"
#include "components/pocolog/OutputFile.hpp"
#include "components/pocolog/SampleTypes.hpp"
#include "components/pocolog/Wire.hpp"

namespace insonify::pocolog {

/** Writes a pocolog v2 file that Rock's readers open, and its index at the end.
 *
 *      Writer log("harbour.0.log");
 *      const size_t ping = log.addStream<types::Sonar>("sonar.ping");
 *      log.write(ping, received, sample);
 *
 *  Blocks gather in memory and go to the file whole: with flush(), close(), or when a megabyte has come together.
 *  A write that fails throws std::runtime_error with the system's reason and leaves what was flushed before, whole;
 *  after it the writer takes nothing more, and kept() tells how much that is. For one thread. Used again, its memory is
 *  not allocated again. */
class Writer {
public:
    /** Creates the file, or empties it. Throws ConfigError when that cannot be done or another Writer, of this process
     * or not, has it open. */
    explicit Writer(std::filesystem::path path);
    ~Writer();  ///< Closes; trouble at that point is not reported.
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    /** Declares a stream "task.port" of T and returns its number. `metadata` joins what Rock's tools look for, and
     *  stands where both have a key. Throws std::length_error for the 65537th stream. */
    template <class T>
    size_t addStream(const std::string& name, Metadata metadata = {}) {
        if constexpr (Stamped<T>) metadata.emplace("rock_timestamp_field", "time");
        metadata.merge(standardMetadata(name, cxxName<T>()));
        return declare(name, typelibName<T>(), registryOf<T>(), metadata);
    }

    /** Declares a stream of a type that this program need not know. Throws as addStream. */
    size_t declare(const std::string& name, const std::string& type, const std::string& registry,
                   const Metadata& metadata);

    /** Adds a sample, received at this moment. Times before 1970 or after 2106 are moved to those years in the block's
     *  header, and one that runs backwards to that of the stream's sample before it: readers search by them. The
     *  stamp in the sample is written as it is. Throws std::length_error above 4 GiB. */
    template <class T>
    void write(size_t stream, types::Time received, const T& sample) {
        const size_t start = beginSample();
        marshal(sample, buffer_);
        endSample(stream, start, received, sampleTime(sample, received));
    }

    /** The same for a sample that is bytes already. */
    void write(size_t stream, types::Time received, types::Time time, std::span<const char> bytes);

    void flush();  ///< Hands all samples to the system: they survive the end of this process.
    void close();  ///< Flushes, closes, writes the index. Nothing may be written after it.
    /** Closes and goes on in another file, with the same streams. Throws as the constructor and close(). */
    void next(std::filesystem::path path);

    const std::filesystem::path& path() const { return path_; }
    uint64_t size() const { return flushed_ + buffer_.size(); }  ///< Of the file, with what is not flushed [B].
    uint64_t kept() const { return taken_ - unflushed_; }        ///< Samples that were flushed, in all files.

private:
    struct Stream {
        StreamIndex index;
        size_t declaration = 0;                ///< Position within `declarations_` [B].
        types::Time last_received, last_time;  ///< In this file or the one before.
    };

    static Metadata standardMetadata(const std::string& name, const std::string& cxx_type);
    void open();
    bool isOpen() const { return file_ && file_->isOpen(); }  ///< Not after a failure.
    size_t beginSample();
    void endSample(size_t stream, size_t start, types::Time received, types::Time time);
    void put(const void* data, size_t size);

    std::filesystem::path path_;
    std::optional<OutputFile> file_;
    std::vector<char> buffer_;  ///< Whole blocks that are not in the file yet.
    uint64_t flushed_ = 0;      ///< Size of the file [B].
    uint64_t taken_ = 0, unflushed_ = 0;
    std::vector<char> declarations_;  ///< The blocks that declare all streams, for the next file.
    std::vector<Stream> streams_;
};

}  // namespace insonify::pocolog
