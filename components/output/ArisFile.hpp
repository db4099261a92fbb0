#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "components/output/FanFile.hpp"

namespace insonify::output {

/** Reads the frames of an .aris file (Sound Metrics, ARIS File SDK: DDF version 5).
 *
 *  Codes are levels, 80 dB from 0 to 255. Beams have the bearings of ArisBeams. Bins before the window are 0; the
 * window begins at the nearest bin. A pose has latitude and longitude of the header, the platform's depth, and the
 * angles of the sonar's compass, or where that has none the platform's; without a position it stays at x = y = 0. */
class ArisFile final : public FanFile {
public:
    /** Whether a file begins as one, or as one of the DIDSON's, which came before it. */
    static bool isOne(const std::filesystem::path& path);
    /** Throws types::ConfigError for a file that cannot be read or is of another version. */
    explicit ArisFile(const std::filesystem::path& path);

    std::optional<double> dynamicRange() const override { return 80; }

private:
    /** What a frame's header states of its samples. */
    struct Shape {
        std::span<const double> bearings;  ///< [deg]
        uint32_t first = 0;                ///< Bins before the window.
        double period = 0, speed = 0;      ///< Of a sample, two-way [s]; of sound [m/s].
        double frequency_khz = 0;
    };

    std::optional<FanFrame> read() override;
    uint64_t sizeOf(std::span<const char> header) const;
    Shape shapeOf(std::span<const char> header) const;
    types::Time timeOf(std::span<const char> header) const;
    std::optional<Stated> stated(std::span<const char> header);

    std::optional<bool> has_place_;  ///< The first frame states where it is on the earth.
};

}  // namespace insonify::output
