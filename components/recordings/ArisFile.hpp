#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "components/recordings/RecordingReader.hpp"

namespace insonify::recordings {

/** Models of the ARIS, by their numbers in the file. */
enum class ArisModel : uint32_t { Aris1800 = 0, Aris3000 = 1, Aris1200 = 2 };

/** Returns the bearings of the beams in the order of the samples, from starboard to port; positive to port [deg]. The
 *  lens spaces the beams unevenly. The bearings are averages of several lenses, published by Sound Metrics (ARIS File
 *  SDK, beam-width-metrics, 2018). Empty for a model without such beams or lens. */
std::span<const double> arisBearings(ArisModel model, uint32_t beams, bool is_telephoto);

/** Reads the frames of an .aris file (Sound Metrics, ARIS File SDK: DDF version 5).
 *
 *  Codes are levels, 80 dB from 0 to 255. Beams have the bearings of arisBearings(). Bins before the window are 0; the
 *  window begins at the nearest bin. A pose has the header's latitude and longitude, the platform's depth, and the
 *  angles of the sonar's compass. Without that compass it has the platform's angles; without a position it stays at x =
 *  y = 0. */
class ArisFile final : public RecordingReader {
public:
    /** Throws types::ConfigError for a file that cannot be read or has another version, as those of the ARIS'
     *  predecessor, the DIDSON. */
    explicit ArisFile(const std::filesystem::path& path);

private:
    /** The layout of a frame's samples, from its header. */
    struct Shape {
        std::span<const double> bearings;  ///< [deg]
        uint32_t first = 0;                ///< Bins before the window.
        double period = 0, speed = 0;      ///< Two-way sample period [s]; speed of sound [m/s].
        double frequency_khz = 0;
    };

    std::optional<RecordedPing> read() override;
    uint64_t getSize(std::span<const char> header) const;
    Shape getShape(std::span<const char> header) const;
    types::Time getTime(std::span<const char> header) const;
    std::optional<Stated> stated(std::span<const char> header);

    std::optional<bool> has_place_;  ///< Whether the first frame has a position on the earth.
};

}  // namespace insonify::recordings
