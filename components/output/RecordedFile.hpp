#pragma once
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/output/LocalOrigin.hpp"
#include "types/Pose.hpp"
#include "types/Sonar.hpp"

namespace insonify::output {

/** The number at a place that the caller knows to be there; little endian, as the processors that this runs on. */
template <class T>
T field(std::span<const char> bytes, size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/** The file of another program or device, read packet by packet: bytes, places of damage, poses and ranges.
 *
 *  Bins have their slant ranges: where `bin_duration` in whole microseconds is not that of a sample, the ping's speed
 * of sound differs from the file's. Poses are those of the sonar, in metres from LocalOrigin. */
class RecordedFile {
public:
    virtual ~RecordedFile() = default;
    RecordedFile(const RecordedFile&) = delete;
    RecordedFile& operator=(const RecordedFile&) = delete;

    /** The place that is x = y = 0 of the poses; empty before the first pose. */
    const std::string& origin() const { return origin_.text(); }
    /** What was passed over or is unknown in the pings until now. */
    virtual std::vector<std::string> notices() const;

protected:
    /** Where the sonar was, in the units of the file [deg]; z is `depth` below the surface [m]. */
    struct Stated {
        bool in_degrees = false;
        double north = 0, east = 0;                          ///< [m], or latitude and longitude [deg].
        double depth = 0, heading = 0, pitch = 0, roll = 0;  ///< Pitch is positive bow up, roll to starboard.
    };

    /** Throws types::ConfigError for a file that cannot be read. @param kind "a recording of a side-scan" */
    RecordedFile(const std::filesystem::path& path, const char* kind);

    [[noreturn]] void fail(uint64_t byte, const std::string& why) const;
    /** @param place "log.dat, byte 21" */
    [[noreturn]] void fail(const std::string& place, const std::string& why) const;
    /** Bytes of the file, at most so many. */
    std::vector<char> take(uint64_t at, size_t size);
    /** The bytes of the packet at `next_`, which becomes `at_`, with a header of so many; empty: the file is at its
     *  end. @param sizeOf gives the size of the whole from the header, or fails */
    template <class SizeOf>
    std::vector<char> takePacket(size_t header, SizeOf&& sizeOf) {
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
    /** Sets duration of a bin and speed of sound, so that a bin has this length [m]. */
    void setResolution(double resolution, double speed_of_sound, types::Sonar& ping);
    /** The pose in the world; unknown where it is not stated or none of the earth. */
    types::Pose placed(types::Time time, const std::optional<Stated>& stated);

    uint64_t at_ = 0, next_ = 0;  ///< Where this packet and the next begin [B].
    uint64_t size_ = 0;           ///< The file's [B].

private:
    std::filesystem::path path_;
    std::ifstream file_;
    LocalOrigin origin_;
    std::optional<uint64_t> cut_off_;  ///< Where the packet begins that the end of the file cuts off [B].
    std::string rounding_;
    size_t without_pose_ = 0;
};

}  // namespace insonify::output
