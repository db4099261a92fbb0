#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/output/LocalOrigin.hpp"
#include "components/output/Xtf.hpp"

namespace insonify::output {

/** A ping of an XTF file and what its record states next to its lines. */
struct XtfLine {
    types::Sonar ping;  ///< Beams to starboard and to port, nearest bin first, as sonar::SideScanTask has them.
    XtfPing record;
    double frequency_khz = 0;  ///< 0: unknown.
};

/** Reads the side-scan pings of an XTF file, those of others too: the first channel to port and the first to starboard.
 *
 *  Samples are the file's: whole numbers, or floats; times 2^-weight where a channel has a weight. Bins have their
 *  slant ranges: where `bin_duration` in whole microseconds is not that of a sample, the ping's speed of sound differs
 *  from the file's. Poses are those of the sonar, else of the ship, in metres from LocalOrigin. */
class XtfFile {
public:
    /** Whether a file begins as one. */
    static bool isOne(const std::filesystem::path& path);
    /** Throws types::ConfigError for a file that cannot be read or is none. */
    explicit XtfFile(const std::filesystem::path& path);

    /** The next ping; none: the file is at its end. Throws types::ConfigError with the byte at which it is damaged. A
     *  packet that the end of the file cuts off is no damage. */
    std::optional<XtfLine> next();
    /** Of the poses: which place is x = y = 0; empty before the first pose. */
    const std::string& origin() const { return origin_.text(); }
    /** What was passed over or is unknown in the pings until now. */
    std::vector<std::string> notices() const;

private:
    struct Channel {
        uint8_t type = 0, format = 0;
        size_t sample_bytes = 0;
        uint32_t sample_count = 0;  ///< Where a ping states none.
        types::Angle beam_width, beam_height;
        double frequency_khz = 0;
    };
    /** A channel of a ping. */
    struct Side {
        const Channel* channel = nullptr;
        std::span<const char> header, samples;
        uint64_t at = 0;  ///< Of the header in the file [B].
        uint32_t count = 0;
        double range = 0;  ///< [m]
        double resolution() const { return range / count; }
    };
    struct Sides {
        std::optional<Side> port, starboard;
    };

    [[noreturn]] void fail(uint64_t byte, const std::string& why) const;
    std::vector<char> take(uint64_t at, size_t size);
    void readChannels();
    bool readPacket();
    std::optional<XtfLine> line();
    Sides sides();
    Side side(size_t offset) const;
    double rangeOf(const Side& side, double speed_of_sound) const;
    double speedOfSound() const;
    types::Time time() const;
    types::Pose pose(types::Time time);
    void setBins(const Sides& sides, double speed_of_sound, types::Sonar& ping);
    void appendBins(const Side& side, bool far_first, types::Sonar& ping) const;

    std::filesystem::path path_;
    std::ifstream file_;
    uint64_t size_ = 0, at_ = 0, next_ = 0;  ///< Of the file, and where this packet and the next begin [B].
    bool in_degrees_ = false;
    std::vector<Channel> channels_;
    std::vector<char> packet_;
    types::Time last_;
    LocalOrigin origin_;

    std::string cut_off_, rounding_;
    std::map<int, size_t> other_packets_;      ///< By type.
    std::map<size_t, size_t> other_channels_;  ///< By number.
    size_t without_side_ = 0, without_pose_ = 0;
};

}  // namespace insonify::output
