#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/recordings/RecordingReader.hpp"

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

/** Reads the images of a .glf file (Tritech Gemini), of the first sonar in it. A .glf file is an archive whose .dat
 *  file has the records.
 *
 *  Samples are the file's, unpacked; the meaning of their values is not published. Bearings are those of each image's
 *  table. A range line is one period of the modulation frequency, two-way. The file has no poses. Times, which count
 *  from 1980, are taken as UTC. */
class GlfFile final : public RecordingReader {
public:
    /** Throws types::ConfigError for a file that cannot be read or has no records. */
    explicit GlfFile(const std::filesystem::path& path) : RecordingReader(path), entry_(path, ".dat") {}

    std::vector<std::string> notices() const override;

private:
    /** The offsets of the parts of an image's record [B], and their numbers. */
    struct Image {
        uint32_t start_range = 0, end_range = 0, beams = 0;
        int compression = 0;
        size_t packed = 0, packed_size = 0, bearings = 0, tail = 0, size = 0;
        /** Returns the number of samples of the stated lines; the lines before the first may also be present. */
        size_t samples() const { return size_t{beams} * (end_range - start_range); }
        size_t allSamples() const { return size_t{beams} * end_range; }
    };

    std::optional<RecordedPing> read() override;
    bool endsHere(std::span<const char> head);
    Image getImage(std::span<const char> head) const;
    std::optional<RecordedPing> getFrame(std::span<const char> record, const Image& image);
    std::vector<char> getSamples(std::span<const char> record, const Image& image) const;
    std::vector<double> readBearings(std::span<const char> record, const Image& image) const;
    void setRanges(std::span<const char> tail, const Image& image, RecordedPing& to);
    /** Skips a part of this record and everything up to the next record. */
    void skipToRecord(size_t size);
    [[noreturn]] void failAt(size_t offset, const std::string& why) const;

    ZipEntry entry_;
    std::optional<uint16_t> device_;  ///< The device whose images are read.
    double stamp_ = 0;                ///< Time of the last record, since 1980 [s].
    std::optional<uint64_t> cut_off_record_;
    std::map<int, size_t> other_types_;    ///< Records by type.
    std::map<int, size_t> other_devices_;  ///< Images by device.
    size_t zooms_ = 0, videos_ = 0, inverted_ = 0;
};

}  // namespace insonify::recordings
