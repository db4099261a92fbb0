#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace insonify::recordings {

/** Reads a file in a zip archive from beginning to end. The archive's directory is not needed, so that a truncated
 *  archive, which libraries refuse, can be read up to its end. */
class ZipEntry {
public:
    /** Opens the first file whose name ends in `ending`. Throws types::ConfigError if there is none, and for methods
     *  other than stored and deflated. */
    ZipEntry(const std::filesystem::path& path, const std::string& ending);
    ~ZipEntry();
    ZipEntry(const ZipEntry&) = delete;
    ZipEntry& operator=(const ZipEntry&) = delete;

    const std::string& name() const;
    /** Returns the `size` bytes from at() on, fewer at the end. They are valid until the next call. */
    std::span<const char> peek(size_t size);
    /** Skips bytes that were peeked. */
    void skip(size_t size);
    /** Returns the offset of the next byte in the file [B]. */
    uint64_t at() const;
    /** Returns why the file ended early, or what is wrong with its bytes; empty if nothing is. */
    const std::string& diagnostic() const;

private:
    struct Source;
    std::unique_ptr<Source> source_;
};

}  // namespace insonify::recordings
