#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/recordings/RecordingReader.hpp"

namespace insonify::recordings {

/** Reads the side-scan pings of a JSF file (EdgeTech, 0004824 and 0023492: messages of type 80, channel 0 to port and 1
 *  to starboard). Reads the first subsystem of 20, 21 and 22 that occurs.
 *
 *  Samples are envelopes, or the magnitude of analytic data, times 2^-weight; samples before matched filtering are
 *  omitted. Both sides of a ping have the same number; a side without the other becomes a ping of one beam. */
class JsfFile final : public RecordingReader {
public:
    /** Throws types::ConfigError for a file that cannot be read. */
    explicit JsfFile(const std::filesystem::path& path) : RecordingReader(path) {}

    std::vector<std::string> notices() const override;

private:
    /** The message of one side. */
    struct Side {
        std::vector<char> message;
        uint64_t at = 0;  ///< Offset of the message in the file [B].
        bool is_port = false, is_complex = false;
        uint32_t number = 0, first = 0, count = 0;  ///< The ping's number; bins before the samples; samples.
        double resolution = 0;                      ///< Slant range per sample [m].
    };

    std::optional<RecordedPing> read() override;
    std::optional<Side> nextSide();
    bool isWanted();
    Side side() const;
    double speedOfSound(const Side& side) const;
    types::Time time(const Side& side) const;
    static std::optional<Stated> stated(const Side& side);
    RecordedPing line(const Side& a, const Side* b);
    static void append(const Side& side, types::Sonar& ping);

    std::vector<char> packet_;
    std::optional<Side> waiting_;  ///< The first side of the next ping.
    std::optional<int> subsystem_;
    std::map<int, size_t> other_messages_;    ///< By type.
    std::map<int, size_t> other_subsystems_;  ///< By number.
    std::map<int, size_t> other_formats_;     ///< By data format.
};

}  // namespace insonify::recordings
