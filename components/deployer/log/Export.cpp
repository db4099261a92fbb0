#include "components/deployer/log/Export.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "components/console/Console.hpp"
#include "components/deployer/log/LoggedTrack.hpp"
#include "components/deployer/log/RecordedSettings.hpp"
#include "components/deployer/log/ReplaySpec.hpp"
#include "components/framework/config/DeploymentSpec.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "components/log/Reader.hpp"
#include "components/output/ByteFile.hpp"
#include "components/output/PictureFiles.hpp"
#include "components/output/pictures/FanImage.hpp"
#include "components/output/pictures/SideScanImage.hpp"
#include "components/recordings/Xtf.hpp"
#include "components/replay/ReplayTask.hpp"
#include "types/samples/Image.hpp"
#include "types/samples/Pose.hpp"

namespace insonify::deployer {
namespace {

using framework::child;
using framework::DeploymentSpec;
using framework::TaskSpec;

constexpr const char* quaternion_order = "w, x, y, z";

/** Returns the nearest task whose type starts with `type` upstream of a task, or the task itself; null when there is
 * none. */
const TaskSpec* upstreamSpec(const DeploymentSpec& spec, const std::string& from, const std::string& type) {
    std::vector<std::string> waiting{from};
    for (size_t i = 0; i < waiting.size(); ++i) {
        const TaskSpec* task = spec.task(waiting[i]);
        if (task && task->type.starts_with(type)) return task;
        for (const framework::ConnectionSpec& connection : spec.connections) {
            const std::string writer = framework::splitPort(connection.from).first;
            if (framework::splitPort(connection.to).first == waiting[i] && std::ranges::count(waiting, writer) == 0)
                waiting.push_back(writer);
        }
    }
    return nullptr;
}

/** Returns a property as written, by its path. */
Json property(const TaskSpec* task, std::initializer_list<const char*> path) {
    if (!task) return nullptr;
    YAML::Node node = task->properties;
    for (const char* key : path) node.reset(child(node, key));
    return toJson(node);
}

Json orElse(const Json& value, const char* otherwise) { return value.is_null() ? Json(otherwise) : value; }

std::string getBins(const std::string& model, const std::string& output, bool amplified) {
    const std::string gain = amplified ? ", times the receiver's gain" : "";
    const std::string intensity =
        model == "physical" ? "received intensity of the bin relative to that of the source at 1 m, linear" + gain
                            : "mean of S(n.d) over what the bin shows, 0 to 1" + gain;
    if (output == "intensity") return intensity;
    if (output == "amplitude") return "root of: " + intensity;
    if (output == "level_db") return "10 log10 of: " + intensity;
    if (output == "received_level_db") return "dB re 1 uPa: source level plus 10 log10 of: " + intensity;
    return "whole numbers by `code`, of: " + intensity;
}

/** Returns the sonar's frequency, else that of its absorption [kHz]; null where neither is given. */
Json getFrequency(const TaskSpec* sonar) {
    const Json frequency = property(sonar, {"frequency_khz"});
    return frequency.is_null() ? property(sonar, {"absorption", "frequency_khz"}) : frequency;
}

Json pingMeaning(const DeploymentSpec& spec, const std::string& task) {
    const TaskSpec* sonar = upstreamSpec(spec, task, "sonar::");
    const TaskSpec* receiver = upstreamSpec(spec, task, "receiver::ReceiverTask");
    const TaskSpec* noise = upstreamSpec(spec, task, "noise::NoiseTask");
    const TaskSpec* scene = upstreamSpec(spec, task, "scene::SceneTask");
    const std::string model = orElse(property(sonar, {"model"}), "physical"),
                      output = orElse(property(receiver, {"output"}), "intensity");
    return {{"bins", getBins(model, output, receiver != nullptr)},
            {"output", output},
            {"model", model},
            {"reference", model == "physical" ? Json("intensity of the source at 1 m") : Json(nullptr)},
            {"tvg", property(receiver, {"tvg"})},
            {"gain_db", property(receiver, {"gain_db"})},
            {"code", property(receiver, {"code"})},
            {"noise", noise ? toJson(noise->properties) : Json(nullptr)},
            {"frequency_khz", getFrequency(sonar)},
            {"absorption", property(sonar, {"absorption"})},
            {"range_m", "slant range of the middle of each bin, [pings, bins]"},
            {"bin_duration",
             "one-way travel time through one bin [s], as Rock defines it: bin k covers slant ranges "
             "[k, k + 1) * bin_duration * speed_of_sound. In logs it is in whole microseconds; where bins are not, the "
             "samples' speed_of_sound makes up for it, and insonify_speed_of_sound in the stream's metadata is the "
             "water's"},
            {"frame", "sonar: x ahead, y to port, z up; bearings from ahead, positive to port [rad]"},
            {"mount", property(scene, {"mount"})},
            {"quaternion_order", quaternion_order}};
}

/** Adds what the recording states from which a stream was imported, see RecordedLog. */
void addRecorded(const log::Stream& stream, Json& meaning) {
    const auto number = [&](const char* key) { return console::readJson(stream.metadatum(key)); };
    if (const Json frequency = number("insonify_frequency_khz"); frequency.is_number() && frequency > 0)
        meaning["frequency_khz"] = frequency;
    if (const Json bits = number("insonify_code_bits"); bits.is_number() && meaning["code"].is_object())
        meaning["code"]["bits"] = bits;
    const std::string recording = stream.metadatum("insonify_recording");
    if (recording.empty()) return;
    meaning["bins"] = "samples of " + recording + ", as its device output them";
    meaning["model"] = meaning["reference"] = nullptr;
    if (meaning["output"] != "code") meaning["output"] = "samples";
}

Json poseMeaning() {
    return {{"position", "in the world, x north, y west, z up [m]"},
            {"orientation", "world_from_body, unit quaternion; body: x forward, y left, z up"},
            {"quaternion_order", quaternion_order}};
}

/** Returns the meaning of a sample's fields, from the type's description. */
template <class T>
Json getFields() {
    Json fields = Json::object();
    const auto report = [&](const types::Field& field, const auto&) {
        const std::string unit = field.unit;
        fields[field.name] = std::string(field.doc) + (unit.empty() || unit == "1" ? "" : " [" + unit + "]");
    };
    const T sample;
    T::describe(sample, report);
    return fields;
}

Json cloudMeaning(const std::optional<types::Datum>& datum) {
    Json meaning = {{"points", "in the world, x north, y west, z up [m]"},
                    {"intensity", "value of the strongest bin of each return, in the units of the sonar's bins"}};
    if (datum) meaning["datum"] = Json::parse(framework::flowYaml(*datum));
    return meaning;
}

}  // namespace

DeploymentSpec getDeployment(const log::Reader& log) try {
    return DeploymentSpec::parse(log.metadatum("insonify_deployment"), log.path().string());
} catch (const types::ConfigError&) {
    return {};
}

Json readMeaning(const log::Reader& log, const log::Stream& stream) {
    Json meaning = {{"stream", stream.name}};
    if (log::holdsPings(stream)) {
        DeploymentSpec spec = getDeployment(log);
        setRecorded(log, spec);
        meaning.update(pingMeaning(spec, findWriter(spec, stream.name)));
        addRecorded(stream, meaning);
    } else if (stream.holds<types::Pose>())
        meaning.update(poseMeaning());
    else if (stream.holds<types::SonarTruth>())
        meaning.update(getFields<types::SonarTruth>());
    else if (stream.holds<types::SonarReturns>())
        meaning.update(getFields<types::SonarReturns>());
    else if (stream.holds<types::SonarDetections>())
        meaning.update(getFields<types::SonarDetections>());
    else if (stream.holds<types::SonarElements>())
        meaning.update(getFields<types::SonarElements>());
    else if (stream.holds<types::PointCloud>())
        meaning.update(cloudMeaning(replay::recordedDatum(log)));
    else
        meaning["type"] = stream.type;
    if (const std::string names = stream.metadatum("insonify_objects"); !names.empty())
        meaning["objects"] = console::readJson(names);
    if (const std::string seed = stream.metadatum("insonify_seed"); !seed.empty()) meaning["seed"] = seed;
    return meaning;
}

const log::Stream& getPings(const log::Reader& log, const std::string& stream, const char* wanted) {
    const log::Stream& pings = log.streams()[log.findIndex(stream)];
    if (!holdsPings(pings)) throw types::ConfigError(log.path(), pings.name, "holds " + pings.type + "; " + wanted);
    if (pings.count == 0) throw types::ConfigError(log.path(), pings.name, "holds no ping");
    return pings;
}

double getFrequency(const Json& meaning) {
    const Json& frequency = meaning["frequency_khz"];
    return frequency.is_number() ? frequency.get<double>() : 0;
}

namespace fs = std::filesystem;

output::DisplayConfig displayFor(const log::Reader& log, const log::Stream& stream, const types::Sonar& ping) {
    output::DisplayConfig display;
    const Json meaning = readMeaning(log, stream);
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
        readPing(log, *std::ranges::find(log.samples(), log.findIndex(stream.name), &log::SampleRef::stream), ping);
    return ping;
}

/** Writes the lines of a side-scan as waterfalls: a picture whenever one is full or the settings change, and of the
 *  last lines. */
class Waterfalls {
public:
    /** @param altitudes of the lines, which are then shown along the ground; null: in slant range */
    Waterfalls(const output::DisplayConfig& display, const LoggedAltitudes* altitudes, fs::path path)
        : image_(getConfig(display, altitudes != nullptr)), altitudes_(altitudes), path_(std::move(path)) {}

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
    static output::SideScanPictureConfig getConfig(const output::DisplayConfig& display, bool along_ground) {
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
    const log::Stream& exported = log.streams()[log.findIndex(stream)];
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
const log::Stream* getPoses(log::Reader& log, const std::string& asked) {
    if (!asked.empty()) {
        const log::Stream& poses = log.streams()[log.findIndex(asked)];
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
    const log::Stream& pings = getPings(log, stream, "an XTF file takes the lines of a side-scan");
    const Json meaning = readMeaning(log, pings);
    const bool codes = meaning.value("output", Json()) == "code";
    const recordings::XtfFormat format{codes ? recordings::XtfSamples::Uint16 : recordings::XtfSamples::Float32,
                                       getFrequency(meaning), to.filename().string()};
    const log::Stream* const placed = getPoses(log, poses);
    if (!placed)
        console::printDiagnostic("notice: {} holds no poses: the lines have no positions\n", log.path().string());
    const LoggedTrack track(log, placed, findMount(meaning));
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
