#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/log/Files.hpp"
#include "components/log/Writer.hpp"
#include "components/log/pocolog/BlockFile.hpp"
#include "components/log/pocolog/Reader.hpp"

namespace insonify::log::pocolog {

/** Writes a pocolog v2 file that Rock's readers open, and its index at the end. Complete blocks are written after each
 *  megabyte. Memory is reused. */
class Writer final : public log::Writer {
public:
    /** Throws as createLog. */
    explicit Writer(std::filesystem::path path);
    ~Writer() override;
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    using log::Writer::write;
    /** `metadata` is merged into the keys that Rock's tools expect, and wins for equal keys. */
    size_t add(size_t sample, const std::string& name, const Metadata& metadata) override;
    /** Declares a stream of a type that this program need not know. Throws as addStream(). */
    size_t declare(const std::string& name, const std::string& type, const std::string& registry,
                   const Metadata& metadata);
    /** The same with metadata as written, in YAML. */
    size_t declareRaw(const std::string& name, const std::string& type, const std::string& registry,
                      const std::string& yaml);

    /** In the block's header, times before 1970 or after 2106 are set to those limits. A time earlier than that of the
     *  stream's previous sample by at most types::max_lateness is set to the latter, because readers search by these
     *  times; an earlier one is kept, because the clock was set back. The stamp in the sample is not changed. Throws
     *  std::length_error above 4 GiB. */
    void put(size_t stream, types::Time received, types::Time time, types::SampleView sample) override;
    /** The same for the bytes of a sample. */
    void write(size_t stream, types::Time received, types::Time time, std::span<const char> bytes);
    size_t addLike(const log::Reader& log, size_t stream, const Metadata& more = {}) override;
    void copy(size_t stream, log::Reader& log, const SampleRef& at) override;

    void flush() override;
    void sync() override;
    void close() override;  ///< Also writes the index.
    void next(std::filesystem::path path) override;

    bool isOpen() const override { return file_ && file_->isOpen(); }
    const std::filesystem::path& path() const override { return path_; }
    uint64_t size() const override { return flushed_ + buffer_.size(); }
    uint64_t kept() const override { return taken_ - unflushed_; }

private:
    struct Written {
        StreamIndex index;
        size_t declaration = 0;                ///< Position within `declarations_` [B].
        types::Time last_received, last_time;  ///< In this file or the one before.
    };

    static Metadata standardMetadata(const std::string& name, const std::string& cxx_type);
    void open();
    size_t beginSample();
    void endSample(size_t stream, size_t start, types::Time received, types::Time time);
    void append(const void* data, size_t size);

    std::filesystem::path path_;
    std::optional<OutputFile> file_;
    std::vector<char> buffer_;  ///< Complete blocks that are not in the file yet.
    uint64_t flushed_ = 0;      ///< Size of the file [B].
    uint64_t taken_ = 0, unflushed_ = 0;
    std::vector<char> declarations_;  ///< The blocks that declare all streams, for the next file.
    std::vector<Written> streams_;
};

}  // namespace insonify::log::pocolog
