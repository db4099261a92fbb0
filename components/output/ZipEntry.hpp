#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace insonify::output {

/** A file in a zip archive, read from its begin to its end. The archive's directory is not needed, so that an archive
 *  that was cut off, which libraries refuse, is read up to there. */
class ZipEntry {
public:
    /** Whether a file begins as an archive. */
    static bool isArchive(const std::filesystem::path& path);
    /** Opens the first file whose name ends so. Throws types::ConfigError where there is none, and for methods other
     *  than stored and deflated. */
    ZipEntry(const std::filesystem::path& path, const std::string& ending);
    ~ZipEntry();
    ZipEntry(const ZipEntry&) = delete;
    ZipEntry& operator=(const ZipEntry&) = delete;

    const std::string& name() const;
    /** The bytes from at() on, `size` of them, fewer at the end. They stay until the next call. */
    std::span<const char> peek(size_t size);
    /** Passes over bytes that were seen. */
    void skip(size_t size);
    /** Where in the file the next byte is [B]. */
    uint64_t at() const;
    /** Why the file ended early, or what is wrong with its bytes; empty: nothing. */
    const std::string& diagnostic() const;

private:
    struct Source;
    std::unique_ptr<Source> source_;
};

}  // namespace insonify::output
