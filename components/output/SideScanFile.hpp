#pragma once
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "components/output/RecordedFile.hpp"
#include "components/output/Xtf.hpp"

namespace insonify::output {

/** A ping of a recording and what its record states next to its lines. */
struct SideScanLine {
    types::Sonar ping;  ///< Beams to starboard and to port, nearest bin first, as sonar::SideScanTask has them.
    XtfPing record;
    double frequency_khz = 0;  ///< 0: unknown.
};

/** A recording of a side-scan, read ping by ping. */
class SideScanFile : public RecordedFile {
public:
    /** The next ping; none: the file is at its end. Throws types::ConfigError with the byte at which it is damaged. A
     *  packet that the end of the file cuts off is no damage. */
    virtual std::optional<SideScanLine> next() = 0;

protected:
    /** Throws types::ConfigError for a file that cannot be read. */
    explicit SideScanFile(const std::filesystem::path& path) : RecordedFile(path, "a recording of a side-scan") {}

    /** Adds a beam of bin_count bins: `count` samples from bin `first` on, and no echo in the others. */
    template <class Sample>
    static void appendBeam(bool is_port, uint32_t first, uint32_t count, Sample&& sample, types::Sonar& ping) {
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

/** Opens a recording by its content; null for a file that is no recording of a side-scan. */
std::unique_ptr<SideScanFile> openSideScan(const std::filesystem::path& path);

}  // namespace insonify::output
