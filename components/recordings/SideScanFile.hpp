#pragma once
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "components/recordings/RecordingReader.hpp"
#include "components/recordings/Xtf.hpp"

namespace insonify::recordings {

/** A ping of a recording and further values of its record. */
struct SideScanLine {
    types::Sonar ping;  ///< Beams to starboard and to port, nearest bin first, as in sonar::SideScanTask.
    XtfPing record;
    double frequency_khz = 0;  ///< 0: unknown.
};

/** Reads a recording of a side-scan ping by ping. */
class SideScanFile : public RecordingReader {
public:
    /** Returns the next ping; none at the end of the file. Throws types::ConfigError with the byte of damage. A packet
     *  truncated by the end of the file is not damage. */
    virtual std::optional<SideScanLine> next() = 0;

protected:
    /** Throws types::ConfigError for a file that cannot be read. */
    explicit SideScanFile(const std::filesystem::path& path) : RecordingReader(path, "a recording of a side-scan") {}

    /** Adds a beam of bin_count bins: `count` samples from bin `first` on, and no echo in the others. */
    static void appendBeam(bool is_port, uint32_t first, uint32_t count, auto&& sample, types::Sonar& ping) {
        const size_t begin = ping.bins.size();
        ping.bins.resize(begin + ping.bin_count);
        for (uint32_t i = 0; i < count; ++i) {
            const float bin = sample(i);
            ping.bins[begin + first + i] = std::isfinite(bin) ? bin : std::numeric_limits<float>::quiet_NaN();
        }
        ping.bearings.push_back(types::Angle::fromDeg(is_port ? 90 : -90));
        ++ping.beam_count;
    }
};

/** Opens a recording by its content; returns null for a file that is not a recording of a side-scan. */
std::unique_ptr<SideScanFile> openSideScan(const std::filesystem::path& path);

}  // namespace insonify::recordings
