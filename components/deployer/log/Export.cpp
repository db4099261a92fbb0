#include "components/deployer/log/Export.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "components/console/Console.hpp"
#include "components/deployer/log/LoggedTrack.hpp"
#include "components/deployer/log/StreamMeaning.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "components/log/Reader.hpp"
#include "components/output/ByteFile.hpp"
#include "components/output/PictureFiles.hpp"
#include "components/output/pictures/FanImage.hpp"
#include "components/output/pictures/SideScanImage.hpp"
#include "components/recordings/Xtf.hpp"
#include "types/samples/Image.hpp"

namespace insonify::deployer {
namespace fs = std::filesystem;

output::DisplayConfig displayFor(const log::Reader& log, const log::Stream& stream, const types::Sonar& ping) {
    output::DisplayConfig display;
    const Json meaning = meaningOf(log, stream);
    if (meaning.value("output", Json()) == "code") {
        display.scale = output::BinScale::Code;
        if (meaning["code"].is_object()) display.code_bits = meaning["code"].value("bits", display.code_bits);
        return display;
    }
    const bool levels = std::any_of(ping.bins.begin(), ping.bins.end(), [](float bin) { return bin < 0; });
    if (levels) display.scale = output::BinScale::Decibel;
    return display;
}

namespace {

/** Turns the samples of one stream into pictures. */
class Pictures {
public:
    Pictures(log::Reader& log, const log::Stream& stream)
        : log_(log), stream_(stream), logged_(stream.holds<types::Image>()) {
        if (!logged_ && !holdsPings(stream))
            throw types::ConfigError(
                log.path(), stream.name,
                fmt::format("holds {}; pictures are made of pings, beams, scans and frames", stream.type));
    }
    const types::Image& of(const log::SampleRef& at) {
        if (logged_)
            log_.read(at, picture_);
        else
            paint(at);
        return picture_;
    }

private:
    void paint(const log::SampleRef& at) {
        readPing(log_, at, ping_);
        if (!fan_) fan_.emplace(displayFor(log_, stream_, ping_));
        fan_->paint(ping_, picture_);
    }

    log::Reader& log_;
    const log::Stream& stream_;
    const bool logged_;  ///< The stream's samples are pictures already.
    std::optional<output::FanImage> fan_;
    types::Sonar ping_;
    types::Image picture_;
};

/** Whether a ping is a line of a side-scan: one beam to port and one to starboard. */
bool isSideScan(const types::Sonar& ping) {
    const auto to = [&](int side) {
        return std::ranges::count_if(ping.bearings,
                                     [&](const types::Angle& bearing) { return bearing.rad * side > 0; });
    };
    return ping.beam_count == 2 && to(1) == 1 && to(-1) == 1;
}

/** Returns the first ping of a stream; without beams if the stream has none. */
types::Sonar firstPing(log::Reader& log, const log::Stream& stream) {
    types::Sonar ping;
    if (log::holdsPings(stream) && stream.count > 0)
        readPing(log, *std::ranges::find(log.samples(), log.indexOf(stream.name), &log::SampleRef::stream), ping);
    return ping;
}

/** Writes the lines of a side-scan as waterfalls: a picture whenever one is full or the settings change, and of the
 *  last lines. */
class Waterfalls {
public:
    /** @param altitudes of the lines, which are then shown along the ground; null: in slant range */
    Waterfalls(const output::DisplayConfig& display, const LoggedAltitudes* altitudes, fs::path path)
        : image_(configOf(display, altitudes != nullptr)), altitudes_(altitudes), path_(std::move(path)) {}

    void add(const types::Sonar& ping) {
        const bool is_other = ping.bin_count != last_.bin_count || ping.binStart(1) != last_.binStart(1);
        if (lines_ > 0) put(is_other || lines_ == output::WaterfallImage::history);
        last_ = ping;
        ++lines_;
    }
    std::vector<fs::path> close() {
        put(true);
        return std::move(files_);
    }

private:
    static output::SideScanPictureConfig configOf(const output::DisplayConfig& display, bool along_ground) {
        output::SideScanPictureConfig config;
        static_cast<output::DisplayConfig&>(config) = display;
        if (along_ground) config.ground_range.emplace();
        return config;
    }
    /** Adds the last line, and writes the picture when `ends`. */
    void put(bool ends) {
        if (altitudes_) image_.setAltitude(altitudes_->nearestTo(last_.time));
        if (!ends) return image_.skip(last_);
        image_.paint(last_, picture_);
        files_.push_back(path_.parent_path() / fmt::format("{}_{:06}.png", path_.stem().string(), files_.size()));
        output::writePng(files_.back(), picture_);
        lines_ = 0;
    }

    output::SideScanImage image_;
    const LoggedAltitudes* const altitudes_;
    fs::path path_;
    types::Sonar last_;
    int lines_ = 0;  ///< Lines of this picture, including the last one.
    types::Image picture_;
    std::vector<fs::path> files_;
};

std::string whyWithoutAltitudes(const log::Reader& log) {
    std::vector<std::string> ranges;
    for (const log::Stream& stream : log.streams())
        if (stream.holds<types::Range>()) ranges.push_back(stream.name);
    if (ranges.empty()) return "takes the altitudes of a stream of ranges, as an altimeter's; the log has none";
    if (ranges.size() == 1) return "takes altitudes; " + ranges.front() + " has no sample";
    return fmt::format("takes the altitudes of one stream; the log has {}; `insonify log cut --stream` keeps some",
                       fmt::join(ranges, ", "));
}

}  // namespace

std::vector<fs::path> exportPictures(log::Reader& log, const std::string& stream, const fs::path& path,
                                     bool along_ground) {
    const log::Stream& exported = log.streams()[log.indexOf(stream)];
    const types::Sonar first = firstPing(log, exported);
    if (along_ground && !isSideScan(first))
        throw types::ConfigError("", "--ground", "is for the lines of a side-scan; " + stream + " has none");
    if (isSideScan(first)) {
        const LoggedAltitudes altitudes(log);
        if (along_ground && !altitudes.areKnown())
            throw types::ConfigError(log.path(), "--ground", whyWithoutAltitudes(log));
        Waterfalls waterfalls(displayFor(log, exported, first), along_ground ? &altitudes : nullptr, path);
        types::Sonar ping;
        log.forEachRef(stream, [&](const log::SampleRef& at) {
            readPing(log, at, ping);
            waterfalls.add(ping);
        });
        return waterfalls.close();
    }
    Pictures pictures(log, exported);
    std::vector<fs::path> files;
    log.forEachRef(stream, [&](const log::SampleRef& at) {
        const types::Image& picture = pictures.of(at);
        files.push_back(path.parent_path() / fmt::format("{}_{:06}.png", path.stem().string(), files.size()));
        output::writePng(files.back(), picture);
    });
    return files;
}

namespace {

[[noreturn]] void refuse(const log::Reader& log, const std::string& stream, const std::string& why) {
    throw types::ConfigError(log.path(), stream, why);
}

// -- XTF --------------------------------------------------------------------------------------------------------------

/** Returns the requested stream of poses, or the only one; null: there is none. */
const log::Stream* posesOf(log::Reader& log, const std::string& asked) {
    if (!asked.empty()) {
        const log::Stream& poses = log.streams()[log.indexOf(asked)];
        if (!poses.holds<types::Pose>()) refuse(log, asked, "holds " + poses.type + "; --pose takes poses");
        return &poses;
    }
    if (const log::Stream* const only = posesOfSonar(log)) return only;
    std::string names;
    for (const log::Stream& stream : log.streams())
        if (stream.holds<types::Pose>()) names += (names.empty() ? "" : ", ") + stream.name;
    if (!names.empty())
        throw types::ConfigError(log.path(), "--pose",
                                 "is missing; name the poses of the side-scan or its vehicle: " + names);
    return nullptr;
}

void refuseUnlessSideScan(const log::Reader& log, const std::string& stream, const types::Sonar& ping) {
    if (!isSideScan(ping))
        refuse(log, stream,
               fmt::format("holds pings of {} beams; an XTF file takes the lines of a side-scan, one beam to port and "
                           "one to starboard",
                           ping.beam_count));
}

}  // namespace

void exportXtf(log::Reader& log, const std::string& stream, const std::string& poses, const fs::path& to) {
    const log::Stream& pings = pingsOf(log, stream, "an XTF file takes the lines of a side-scan");
    const Json meaning = meaningOf(log, pings);
    const bool codes = meaning.value("output", Json()) == "code";
    const recordings::XtfFormat format{codes ? recordings::XtfSamples::Uint16 : recordings::XtfSamples::Float32,
                                       frequencyOf(meaning), to.filename().string()};
    const log::Stream* const placed = posesOf(log, poses);
    if (!placed)
        console::printDiagnostic("notice: {} holds no poses: the lines have no positions\n", log.path().string());
    const LoggedTrack track(log, placed, mountOf(meaning));
    const LoggedAltitudes altitudes(log);
    types::Sonar ping = firstPing(log, pings);
    refuseUnlessSideScan(log, pings.name, ping);
    output::ByteFile file(to);
    std::vector<char> bytes = recordings::xtfHeader(format, ping);
    recordings::XtfPing more;
    types::Time last;
    log.forEachRef(stream, [&](const log::SampleRef& at) {
        readPing(log, at, ping);
        more.sonar = track.at(ping.time);
        more.altitude = altitudes.at(ping.time);
        more.since_last = last.isNull() ? 0 : (ping.time - last).seconds();
        last = ping.time;
        recordings::appendXtfPing(format, ping, more, bytes);
        ++more.number;
        file.append(bytes);
        bytes.clear();
    });
    file.close();
}

void exportOculus(log::Reader& log, const std::string& stream, const fs::path& to) {
    const auto write =
        loader::load("device").entry<void(log::Reader&, const std::string&, const fs::path&)>("insonify_export_oculus");
    write(log, stream, to);
}

}  // namespace insonify::deployer
