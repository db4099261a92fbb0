#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "components/study/CodedPing.hpp"

namespace insonify::study {

/** What is known of the ping that a picture shows: a fan, ahead up and port left, or a column for each beam from port,
 *  the nearest bin lowest (polar). 0 or none: it is found, or the picture is refused. */
struct PictureConfig {
    std::optional<bool> is_fan = {};
    double range = 0;              ///< Slant range of its far edge [m].
    double range_min = 0;          ///< Slant range of its near edge [m]; of a fan it is found from its outline.
    double field_of_view_deg = 0;  ///< Angle between its sides; of a fan it is found from its outline.
    size_t beams = 0;              ///< Number of beams of a fan.
};

/** A fan in a picture, by its outline: pixels that differ from the corners. */
struct FanOutline {
    double column = 0, row = 0;      ///< The sonar's place, which may be below the picture [px].
    double radius = 0, nearest = 0;  ///< Of the far and the near edge [px].
    double half_angle = 0;           ///< [rad]
};

/** Returns whether a file begins as a PNG file. */
bool isPicture(const std::filesystem::path& file);

/** Returns the outline of a fan of less than half a turn; none if the picture shows none.
 *  @param levels row by row from the top */
std::optional<FanOutline> findOutline(const std::vector<uint8_t>& levels, size_t width, size_t height);

/** Reads a picture of codes of 8 bits. A fan gets a bin for each pixel of its radius; each bin has the code of the
 *  nearest pixel. Throws types::ConfigError for a file that is no PNG, and for what is not known and cannot be found.
 */
CodedPing readPicture(const std::filesystem::path& file, const PictureConfig& config, const receiver::CodeConfig& law);

}  // namespace insonify::study
