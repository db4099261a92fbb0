#pragma once
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/vec2.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "components/receiver/Receiver.hpp"
#include "types/geometry/Angle.hpp"
#include "types/samples/Pose.hpp"
#include "types/samples/Sonar.hpp"

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

/** What the pings of a recording are: fans of a forward-looking sonar, lines of a side-scan, or single beams, of a
 *  scanning sonar at different bearings or of an echo sounder. */
enum class RecordedShape { Fan, Line, Scan, Sounder };

class RecordingReader;

/** A format of recordings: a line of the table in RecordingReader.cpp, from which files are recognised and messages are
 *  made. */
struct RecordingFormat {
    std::string_view ending;     ///< Of the files, in lower case; empty: any.
    const char* name;            ///< For messages: "XTF".
    const char* device;          ///< For messages: "a side-scan".
    RecordedShape shape;         ///< Of most files, see RecordingReader::shape().
    std::string_view signature;  ///< The first bytes of each file; empty: any bytes.
    std::unique_ptr<RecordingReader> (*open)(const std::filesystem::path&) = nullptr;  ///< Null: of `component`.
    const char* component = nullptr;  ///< Its component library, with the function insonify_open_recording.
};
/** The formats that can be read; the last one, without a signature, is tried for files that are of no other. */
std::span<const RecordingFormat> recordingFormats();
/** Returns the format of a file by its first bytes. Throws types::ConfigError for a file that cannot be read. */
const RecordingFormat& recognisedFormat(const std::filesystem::path& file);
/** Returns the format with the ending of a file, in any case of letters; null: none has it. */
const RecordingFormat* findRecordingFormat(const std::filesystem::path& file);
/** Throws types::ConfigError where a log is wanted and the file has the ending of a recording, with the command that
 * makes a log of it. */
void refuseRecording(const std::filesystem::path& file);
/** Returns the endings as a message lists them: ".xtf, .jsf or .aris". */
std::string recordingEndings();

/** A ping of a recording, in the frames and units of a simulated one. */
struct RecordedPing {
    types::Sonar ping;  ///< Beams from starboard to port, nearest bin first; a line's are those of sonar::SideScanTask.
    types::Pose sonar;  ///< In the world; not finite: unknown.
    uint32_t number = 0;        ///< As the file states it, or counted from 0.
    double since_first = 0;     ///< Time since the first ping [s].
    double altitude = 0;        ///< Above the bottom [m]; 0: unknown.
    double frequency_khz = 0;   ///< 0: unknown.
    double speed_of_sound = 0;  ///< As the file states it [m/s]; 0: unknown.
    double range = 0;           ///< Slant range of the end of the last bin [m].
    double window_start = 0;    ///< Slant range of the first sample [m]; the bins before it are 0.
    double gain_db = std::numeric_limits<double>::quiet_NaN();  ///< Of the receiver; NaN: unknown.
    double max_code = 0;                                        ///< Max code of the device; 0: bins are no codes.
    receiver::CodeConfig code;  ///< The law of the codes as far as the file states it; at most 16 bits.
    bool law_known = false;     ///< Whether the file states the law.
};

/** Reads the recording of another program or device, ping by ping. This class checks what all formats share: the file,
 *  its first bytes, that it has a ping, the place of damage. A format's reader derives from it, and reads packets.
 *
 *  Bins keep their slant ranges, see types::RangeBins. Poses are the sonar's, in metres from LocalOrigin. */
class RecordingReader {
public:
    /** Opens a recording by its content. Throws types::ConfigError for a file that does not exist, is a folder or
     * empty, or cannot be read, and for a damaged beginning. */
    static std::unique_ptr<RecordingReader> open(const std::filesystem::path& file);
    virtual ~RecordingReader() = default;
    RecordingReader(const RecordingReader&) = delete;
    RecordingReader& operator=(const RecordingReader&) = delete;

    const RecordingFormat& format() const { return format_; }
    RecordedShape shape() const { return shape_; }
    /** Returns the next ping; none at the end of the file. Throws types::ConfigError if the file has no ping, or with
     *  the byte at which the first ping is damaged. Later damage ends the pings, with a notice; a packet that the end
     * of the file cuts off is no damage. */
    std::optional<RecordedPing> next();
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

    /** Throws as open(). */
    explicit RecordingReader(const std::filesystem::path& path);

    /** Returns the next ping, none at the end of the file, or fails. */
    virtual std::optional<RecordedPing> read() = 0;

    [[noreturn]] void fail(uint64_t byte, const std::string& why) const;
    /** @param place "log.dat, byte 21" */
    [[noreturn]] void fail(const std::string& place, const std::string& why) const;
    /** Returns what is wrong with a time since the epoch [us], or with its order; empty if nothing is. */
    std::string findDiagnostic(double time_us) const;
    /** Returns at most `size` bytes of the file. */
    std::vector<char> take(uint64_t at, size_t size);
    /** Returns the packet at `next_`, which becomes `at_`; its header has `header` bytes. Empty at the end of the file.
     *  @param getSize returns the packet's size from the header, or fails */
    std::vector<char> readPacket(size_t header, auto&& getSize) {
        at_ = next_;
        if (at_ >= size_) return {};
        const std::vector<char> head = take(at_, header);
        const uint64_t bytes = head.size() == header ? getSize(head) : std::numeric_limits<uint64_t>::max();
        if (bytes > size_ - at_) {
            cut_off_ = at_;
            next_ = size_;
            return {};
        }
        next_ = at_ + bytes;
        return take(at_, static_cast<size_t>(bytes));
    }
    /** Sets bins of this length [m]; notes if logs contain another speed of sound for it [m/s]. */
    void setResolution(double resolution, double speed_of_sound, RecordedPing& to);
    /** Sets the beams and bins of a fan from samples of 8 bits: `first` bins without echo, then the samples, all beams
     *  of the nearest range first. @param bearings of the samples' beams, in any order [rad] */
    void setFan(std::span<const double> bearings, uint32_t first, std::span<const char> samples, RecordedPing& to);
    /** Adds a side of a line, a beam of bin_count bins: `count` samples from bin `first` on, no echo in the others. */
    static void appendSide(bool is_port, uint32_t first, uint32_t count, auto&& sample, types::Sonar& ping) {
        const size_t begin = ping.bins.size();
        ping.bins.resize(begin + ping.bin_count);
        for (uint32_t i = 0; i < count; ++i) {
            const float bin = sample(i);
            ping.bins[begin + first + i] = std::isfinite(bin) ? bin : std::numeric_limits<float>::quiet_NaN();
        }
        ping.bearings.push_back(types::Angle::fromDeg(is_port ? 90 : -90));
        ++ping.beam_count;
    }
    /** Returns the pose in the world; unknown if it is not stated or not on the earth. */
    types::Pose placed(types::Time time, const std::optional<Stated>& stated);

    RecordedShape shape_{};       ///< That of the format, unless the file has another.
    uint64_t at_ = 0, next_ = 0;  ///< Offsets of this packet and the next [B].
    uint64_t size_ = 0;           ///< Size of the file [B].

private:
    std::filesystem::path path_;
    const RecordingFormat& format_;
    std::ifstream file_;
    LocalOrigin origin_;
    types::Time first_, last_;         ///< Times of the first ping and the last one so far.
    uint32_t count_ = 0;               ///< Pings so far.
    std::string damage_;               ///< The damage that ended the pings; empty: none.
    std::optional<uint64_t> cut_off_;  ///< Offset of the packet that the end of the file truncates [B].
    std::string rounding_;
    size_t without_pose_ = 0;
};

}  // namespace insonify::recordings
