#include "components/recordings/RecordingReader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "types/ConfigError.hpp"

namespace insonify::recordings {

RecordingReader::RecordingReader(const std::filesystem::path& path, const char* kind)
    : path_(path), file_(path, std::ios::binary) {
    if (!file_ || std::filesystem::is_directory(path))
        throw types::ConfigError(path.string(), "", std::string("cannot be read; it must be ") + kind);
    size_ = std::filesystem::file_size(path);
}

void RecordingReader::fail(uint64_t byte, const std::string& why) const { fail(fmt::format("byte {}", byte), why); }

void RecordingReader::fail(const std::string& place, const std::string& why) const {
    throw types::ConfigError(path_.string(), place, why);
}

std::vector<char> RecordingReader::take(uint64_t at, size_t size) {
    std::vector<char> bytes(static_cast<size_t>(std::min<uint64_t>(size, size_ - std::min(at, size_))));
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(at));
    file_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!file_) fail(at, "can no longer be read");
    return bytes;
}

void RecordingReader::setResolution(double resolution, double speed_of_sound, types::Sonar& ping) {
    ping.setBins(resolution, speed_of_sound);
    if (ping.bin_width > 0 && rounding_.empty())
        rounding_ = fmt::format(
            "bins are {:.2f} us long, one way, but samples in logs have whole microseconds: with {} us and a speed of "
            "sound of {:.2f} m/s instead of {:g} m/s their ranges are right",
            1e6 * ping.binSeconds(), ping.bin_duration.microseconds, ping.writtenSpeed(), speed_of_sound);
}

types::Pose RecordingReader::placed(types::Time time, const std::optional<Stated>& stated) {
    const auto isWithin = [](double limit, std::initializer_list<double> values) {
        return std::ranges::all_of(values, [&](double value) { return std::abs(value) <= limit; });
    };
    types::Pose pose;
    pose.time = time;
    pose.source_frame = "sonar";
    pose.target_frame = "world";
    const bool is_usable = stated && isWithin(360, {stated->heading, stated->pitch, stated->roll}) &&
                           isWithin(12000, {stated->depth}) &&
                           (stated->in_degrees ? isWithin(90, {stated->north}) && isWithin(360, {stated->east})
                                               : isWithin(1e8, {stated->north, stated->east}));
    if (!is_usable) {
        ++without_pose_;
        pose.position.x = types::Pose::unknown;
        return pose;
    }
    const glm::dvec2 north_east = stated->in_degrees ? origin_.fromDegrees(stated->north, stated->east)
                                                     : origin_.fromMetres(stated->north, stated->east);
    pose.position = {north_east.x, -north_east.y, -stated->depth};
    const auto turn = [](double deg, const glm::dvec3& axis) { return glm::angleAxis(types::radians(deg), axis); };
    pose.orientation = turn(-std::remainder(stated->heading, 360), {0, 0, 1}) * turn(-stated->pitch, {0, 1, 0}) *
                       turn(stated->roll, {1, 0, 0});
    return pose;
}

std::vector<std::string> RecordingReader::notices() const {
    std::vector<std::string> all;
    if (cut_off_) all.push_back(fmt::format("the packet at byte {} is cut off by the end of the file", *cut_off_));
    if (!rounding_.empty()) all.push_back(rounding_);
    if (!origin().empty()) all.push_back("x = y = 0 of the world is " + origin());
    if (without_pose_ > 0) all.push_back(fmt::format("{} pings have no pose", without_pose_));
    return all;
}

}  // namespace insonify::recordings
