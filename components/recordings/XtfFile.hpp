#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/recordings/RecordingReader.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::recordings {

/** Reads the side-scan pings of an XTF file, also of other programs: the first channel to port and the first to
 *  starboard.
 *
 *  Samples are the file's: integers, or floats; times 2^-weight if a channel has a weight. A ping without a position of
 *  the sonar has the ship's. Channels are read as the header describes them, whatever number of channels it declares.
 *  If samples to one side are longer, that side gets bins of the other's length: each has the sample at its middle. A
 *  ping that contradicts itself is omitted, with a notice of the first. */
class XtfFile final : public RecordingReader {
public:
    /** Throws types::ConfigError for a file that cannot be read or is not an XTF file. */
    explicit XtfFile(const std::filesystem::path& path);

    std::vector<std::string> notices() const override;

private:
    struct Channel {
        uint8_t type = 0, format = 0;
        size_t sample_bytes = 0;    ///< 0: the header does not describe the channel.
        uint32_t sample_count = 0;  ///< Used if no channel of a ping states a number.
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
        /** Returns the number of bins whose middles the samples cover. @param per_bin samples in a bin */
        uint32_t binCount(double per_bin) const;
        /** Adds the beam of the side, with the sample at the middle of each bin. */
        void append(double per_bin, bool is_port, types::Sonar& ping) const;
    };
    using Failure = std::optional<types::ConfigError>;  ///< Why the rest of a ping cannot be read.
    struct Sides {
        std::optional<Side> port, starboard;
    };
    /** Pings with the same oddity, and the place and the reason of the first. */
    struct OddPings {
        size_t count = 0;
        std::string first;
        void add(const std::string& why) {
            if (count++ == 0) first = why;
        }
    };

    std::optional<RecordedPing> read() override;
    void readChannels();
    bool beginsPacket(uint64_t at);
    /** Whether a channel is described at this place behind the first block of the header. */
    bool describesChannel(uint64_t at);
    bool nextPacket();
    std::optional<RecordedPing> line();
    Sides sides();
    /** Returns the channels of a ping up to the first that cannot be read, whose error `failure` becomes.
     *  @param by_header true: a channel that states no number of samples has the header's */
    std::vector<Side> channelsOfPing(bool by_header, Failure& failure) const;
    Side side(size_t offset, bool by_header) const;
    double computeRange(const Side& side, double speed_of_sound) const;
    double speedOfSound() const;
    types::Time time() const;
    std::optional<Stated> stated() const;
    void setBins(const Sides& sides, double speed_of_sound, RecordedPing& to);

    bool in_degrees_ = false;
    size_t declared_ = 0;            ///< Number of channels by the header.
    std::vector<Channel> channels_;  ///< Every place of a channel in the header.
    std::vector<char> packet_;

    std::map<int, size_t> other_packets_;      ///< By type.
    std::map<size_t, size_t> other_channels_;  ///< By number.
    std::map<size_t, size_t> undeclared_;      ///< Channels that the header describes but does not declare, by number.
    size_t without_side_ = 0;
    OddPings omitted_, cut_short_, empty_, resampled_;
};

}  // namespace insonify::recordings
