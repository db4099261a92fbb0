#pragma once
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "types/Angle.hpp"
#include "types/Pose.hpp"
#include "types/Sonar.hpp"

namespace insonify::recordings {

/** The point on the earth that becomes x = y = 0 of the world. The first position sets it. */
class LocalOrigin {
public:
    /** Returns metres north and east of the origin [m]; WGS 84, on the tangent plane at the origin. */
    glm::dvec2 fromDegrees(double latitude, double longitude) {
        if (!origin_) set({latitude, longitude}, "latitude {:.7f}, longitude {:.7f} (WGS 84)");
        constexpr double radius = 6378137, e2 = 6.69437999014e-3;  // [m], [1]
        const double latitude_rad = types::radians(origin_->x), sine = std::sin(latitude_rad);
        const double across = radius / std::sqrt(1 - e2 * sine * sine);  // radius of curvature, east to west
        const double along = across * (1 - e2) / (1 - e2 * sine * sine);
        return {types::radians(latitude - origin_->x) * along,
                types::radians(std::remainder(longitude - origin_->y, 360)) * across * std::cos(latitude_rad)};
    }
    /** Returns metres north and east of the origin [m]. The origin is that of the coordinates, unless the first are too
     *  large to be local; then it is the first position. */
    glm::dvec2 fromMetres(double north, double east) {
        constexpr double local = 1e4;
        const bool is_local = std::abs(north) <= local && std::abs(east) <= local;
        if (!origin_) set(is_local ? glm::dvec2(0) : glm::dvec2(north, east), "north {:.2f} m, east {:.2f} m");
        return glm::dvec2(north, east) - *origin_;
    }
    /** Returns the origin as in the file; empty before the first position. */
    const std::string& text() const { return text_; }

private:
    void set(glm::dvec2 origin, const char* format) {
        origin_ = origin;
        text_ = fmt::format(fmt::runtime(format), origin.x, origin.y);
    }

    std::optional<glm::dvec2> origin_;
    std::string text_;
};

/** Returns the number at an offset that must be within the bytes; little endian, as the processors that this runs
 *  on. */
template <class T>
T field(std::span<const char> bytes, size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/** Reads the file of another program or device packet by packet: bytes, places of damage, poses and ranges.
 *
 *  Bins keep their slant ranges, see types::RangeBins. Poses are the sonar's, in metres from LocalOrigin. */
class RecordingReader {
public:
    virtual ~RecordingReader() = default;
    RecordingReader(const RecordingReader&) = delete;
    RecordingReader& operator=(const RecordingReader&) = delete;

    /** Returns the place of x = y = 0 of the poses; empty before the first pose. */
    const std::string& origin() const { return origin_.text(); }
    /** Returns what was omitted or is unknown in the pings so far. */
    virtual std::vector<std::string> notices() const;

protected:
    /** The sonar's position and angles, in the units of the file [deg]; z is `depth` below the surface [m]. */
    struct Stated {
        bool in_degrees = false;
        double north = 0, east = 0;                          ///< [m], or latitude and longitude [deg].
        double depth = 0, heading = 0, pitch = 0, roll = 0;  ///< Pitch is positive bow up, roll to starboard.
    };

    /** Throws types::ConfigError for a file that cannot be read. @param kind "a recording of a side-scan" */
    RecordingReader(const std::filesystem::path& path, const char* kind);

    [[noreturn]] void fail(uint64_t byte, const std::string& why) const;
    /** @param place "log.dat, byte 21" */
    [[noreturn]] void fail(const std::string& place, const std::string& why) const;
    /** Returns at most `size` bytes of the file. */
    std::vector<char> take(uint64_t at, size_t size);
    /** Returns the packet at `next_`, which becomes `at_`; its header has `header` bytes. Empty at the end of the file.
     *  @param sizeOf returns the packet's size from the header, or fails */
    std::vector<char> takePacket(size_t header, auto&& sizeOf) {
        at_ = next_;
        if (at_ >= size_) return {};
        const std::vector<char> head = take(at_, header);
        const uint64_t bytes = head.size() == header ? sizeOf(head) : std::numeric_limits<uint64_t>::max();
        if (bytes > size_ - at_) {
            cut_off_ = at_;
            next_ = size_;
            return {};
        }
        next_ = at_ + bytes;
        return take(at_, static_cast<size_t>(bytes));
    }
    /** Sets bins of this length [m]; notes if logs contain another speed of sound for it [m/s]. */
    void setResolution(double resolution, double speed_of_sound, types::Sonar& ping);
    /** Returns the pose in the world; unknown if it is not stated or not on the earth. */
    types::Pose placed(types::Time time, const std::optional<Stated>& stated);

    uint64_t at_ = 0, next_ = 0;  ///< Offsets of this packet and the next [B].
    uint64_t size_ = 0;           ///< Size of the file [B].

private:
    std::filesystem::path path_;
    std::ifstream file_;
    LocalOrigin origin_;
    std::optional<uint64_t> cut_off_;  ///< Offset of the packet that the end of the file truncates [B].
    std::string rounding_;
    size_t without_pose_ = 0;
};

}  // namespace insonify::recordings
