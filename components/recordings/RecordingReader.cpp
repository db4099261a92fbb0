#include "components/recordings/RecordingReader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "components/loader/ComponentLibrary.hpp"
#include "components/recordings/ArisFile.hpp"
#include "components/recordings/GlfFile.hpp"
#include "components/recordings/JsfFile.hpp"
#include "components/recordings/XtfFile.hpp"
#include "types/geometry/BeamArc.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::recordings {

namespace {

template <class Reader>
std::unique_ptr<RecordingReader> make(const std::filesystem::path& file) {
    return std::make_unique<Reader>(file);
}

using namespace std::string_view_literals;
using enum RecordedShape;
constexpr RecordingFormat all_formats[] = {
    {".xtf", "XTF", "a side-scan", Line, "\x7B"sv, make<XtfFile>},
    {".jsf", "JSF", "a side-scan", Line, "\x01\x16"sv, make<JsfFile>},
    {".aris", "ARIS", "an ARIS", Fan, "DDF"sv, make<ArisFile>},
    {".glf", "Gemini", "a Gemini", Fan, "PK\3\4"sv, make<GlfFile>},
    {".bin", "Ping Viewer", "a Ping360 or a Ping1D", Scan, "\0\0\0"sv, nullptr, "device"},
    {".oculus", "Oculus", "an Oculus", Fan, "\x44\x33\x22\x11\x30\0\0\0"sv, nullptr, "device"},
    {"", "messages of an Oculus as captured", "an Oculus", Fan, "", nullptr, "device"},
};

}  // namespace

const RecordingFormat& recognisedFormat(const std::filesystem::path& file) {
    const auto refuse = [&](const std::string& why) { throw types::ConfigError(file.string(), "", why); };
    std::error_code error;
    if (!std::filesystem::exists(file, error)) refuse("does not exist; may be a " + recordingEndings() + " file");
    if (std::filesystem::is_directory(file, error)) refuse("is a folder; give a recording in it");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) refuse("cannot be read" + types::permissionReason(errno));
    char bytes[8];
    stream.read(bytes, sizeof bytes);
    const std::string_view head(bytes, static_cast<size_t>(stream.gcount()));
    if (head.empty()) refuse("is empty; may be a " + recordingEndings() + " file");
    return *std::ranges::find_if(all_formats,
                                 [&](const RecordingFormat& format) { return head.starts_with(format.signature); });
}

std::span<const RecordingFormat> recordingFormats() { return all_formats; }

const RecordingFormat* findRecordingFormat(const std::filesystem::path& file) {
    return file.has_extension() ? types::findFormat(all_formats, file) : nullptr;
}

void refuseRecording(const std::filesystem::path& file) {
    if (const RecordingFormat* const format = findRecordingFormat(file))
        throw types::ConfigError(
            file.string(), "",
            fmt::format("is a recording of {}; `insonify log import` makes a log of it", format->device));
}

std::string recordingEndings() {
    return types::alternativeEndings(all_formats, [](const RecordingFormat& format) { return !format.ending.empty(); });
}

std::unique_ptr<RecordingReader> RecordingReader::open(const std::filesystem::path& file) {
    const RecordingFormat& format = recognisedFormat(file);
    if (format.open) return format.open(file);
    using Open = void(const std::filesystem::path&, std::unique_ptr<RecordingReader>&);
    std::unique_ptr<RecordingReader> reader;
    loader::load(format.component).entry<Open>("insonify_open_recording")(file, reader);
    return reader;
}

RecordingReader::RecordingReader(const std::filesystem::path& path)
    : size_(0), path_(path), format_(recognisedFormat(path)), file_(path, std::ios::binary) {
    shape_ = format_.shape;
    size_ = std::filesystem::file_size(path);
}

std::optional<RecordedPing> RecordingReader::next() {
    if (!damage_.empty()) return std::nullopt;
    try {
        std::optional<RecordedPing> ping = read();
        if (ping) {
            if (count_++ == 0) first_ = ping->ping.time;
            last_ = ping->ping.time;
            if (ping->since_first == 0) ping->since_first = (last_ - first_).seconds();
            if (ping->range == 0) ping->range = ping->ping.binStart(ping->ping.bin_count);
        } else if (count_ == 0) {
            std::string why = std::string("holds no ping of ") + format_.device;
            if (format_.signature.empty()) why += ", and does not begin as a " + recordingEndings() + " file does";
            for (const std::string& notice : notices()) why += "; " + notice;
            throw types::ConfigError(path_.string(), "", why);
        }
        return ping;
    } catch (const types::ConfigError& error) {
        if (count_ == 0) throw;
        const types::Diagnostic& found = error.diagnostics().front();
        damage_ = fmt::format("{}: {}; only the {} earlier pings are read", found.path, found.message, count_);
        return std::nullopt;
    }
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

std::string RecordingReader::findDiagnostic(double time_us) const {
    constexpr double year_2200 = 7.26e15;
    if (!(time_us > 0 && time_us < year_2200))
        return fmt::format("the time is {:.6g} s since 1970; it must be above 0 and before the year 2200",
                           time_us * 1e-6);
    const double step = time_us - static_cast<double>(last_.microseconds);
    if (count_ > 0 && step < 0)
        return fmt::format("the time is {:.6g} s before that of the previous ping", -step * 1e-6);
    return "";
}

void RecordingReader::setFan(std::span<const double> bearings, uint32_t first, std::span<const char> samples,
                             RecordedPing& to) {
    types::Sonar& ping = to.ping;
    std::vector<types::Angle> table;
    for (const double bearing : bearings) table.push_back(types::Angle::fromRad(bearing));
    types::BeamArc arc;
    arc.take(table, {});
    const size_t rows = samples.size() / bearings.size();
    ping.beam_count = static_cast<uint32_t>(arc.beams.size());
    ping.bin_count = first + static_cast<uint32_t>(rows);
    ping.bins.assign(size_t{ping.beam_count} * ping.bin_count, 0);
    float* bin = ping.bins.data();
    for (const uint32_t beam : arc.beams) {
        ping.bearings.push_back(table[beam]);
        bin += first;
        for (size_t row = 0; row < rows; ++row) *bin++ = static_cast<uint8_t>(samples[row * bearings.size() + beam]);
    }
    to.number = count_;
    to.max_code = 255;
    to.code.bits = 8;
}

void RecordingReader::setResolution(double resolution, double speed_of_sound, RecordedPing& to) {
    types::Sonar& ping = to.ping;
    ping.setBins(resolution, speed_of_sound);
    to.speed_of_sound = static_cast<double>(ping.speed_of_sound);
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
    if (!damage_.empty()) all.push_back(damage_);
    if (cut_off_) all.push_back(fmt::format("the packet at byte {} is cut off by the end of the file", *cut_off_));
    if (!rounding_.empty()) all.push_back(rounding_);
    if (!origin().empty()) all.push_back("x = y = 0 of the world is " + origin());
    if (without_pose_ > 0) all.push_back(fmt::format("{} pings have no pose", without_pose_));
    return all;
}

}  // namespace insonify::recordings
