#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/recordings/RecordingReader.hpp"

namespace insonify::recordings {

/** Reads the side-scan pings of an XTF file, also of other programs: the first channel to port and the first to
 *  starboard.
 *
 *  Samples are the file's: integers, or floats; times 2^-weight if a channel has a weight. A ping without a position of
 *  the sonar has the ship's. */
class XtfFile final : public RecordingReader {
public:
    /** Throws types::ConfigError for a file that cannot be read or is not an XTF file. */
    explicit XtfFile(const std::filesystem::path& path);

    std::vector<std::string> notices() const override;

private:
    struct Channel {
        uint8_t type = 0, format = 0;
        size_t sample_bytes = 0;
        uint32_t sample_count = 0;  ///< Used if a ping states none.
        types::Angle beam_width, beam_height;
        double frequency_khz = 0;
    };
    /** One channel of a ping. */
    struct Side {
        const Channel* channel = nullptr;
        std::span<const char> header, samples;
        uint64_t at = 0;  ///< Offset of the header in the file [B].
        uint32_t count = 0;
        double range = 0;  ///< [m]
        double resolution() const { return range / count; }
    };
    struct Sides {
        std::optional<Side> port, starboard;
    };

    std::optional<RecordedPing> read() override;
    void readChannels();
    bool nextPacket();
    std::optional<RecordedPing> line();
    Sides sides();
    Side side(size_t offset) const;
    double rangeOf(const Side& side, double speed_of_sound) const;
    double speedOfSound() const;
    types::Time time() const;
    std::optional<Stated> stated() const;
    void setBins(const Sides& sides, double speed_of_sound, RecordedPing& to);
    static void append(const Side& side, bool is_port, types::Sonar& ping);

    bool in_degrees_ = false;
    std::vector<Channel> channels_;
    std::vector<char> packet_;

    std::map<int, size_t> other_packets_;      ///< By type.
    std::map<size_t, size_t> other_channels_;  ///< By number.
    size_t without_side_ = 0;
};

}  // namespace insonify::recordings
