#include "components/study/CodedPing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "components/recordings/RecordingReader.hpp"
#include "components/study/PictureFile.hpp"
#include "types/geometry/BeamArc.hpp"
#include "types/geometry/WorldFrame.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::study {
namespace {

namespace fs = std::filesystem;
using recordings::RecordingReader;

/** Returns the named files, and the files of the named folders: of the folder of a run only what may be a recording. */
std::vector<fs::path> getFiles(const std::vector<std::string>& names, bool with_pictures) {
    static const std::set<std::string> others{".idx", ".yml", ".yaml", ".json", ".csv", ".npz", ".md", ".html",
                                              ".txt", ".py",  ".glb",  ".gltf", ".mp4", ".avi", ".mkv"};
    const auto isOther = [&](const fs::path& file) {
        return others.contains(file.extension()) || file.filename() == "properties.0.log" ||
               (!with_pictures && isPicture(file));
    };
    std::vector<fs::path> files;
    fs::path picture;  // one that is left out
    for (const fs::path name : names) {
        if (!fs::is_directory(name)) {
            files.push_back(name);
            continue;
        }
        for (const auto& entry : fs::directory_iterator(name))
            if (entry.is_regular_file() && !isOther(entry.path()))
                files.push_back(entry.path());
            else if (entry.is_regular_file() && isPicture(entry.path()))
                picture = entry.path();
    }
    if (files.empty() && !picture.empty()) files.push_back(picture);
    std::ranges::sort(files);
    return files;
}

/** Returns the law of codes with the bits of the max code. */
receiver::CodeConfig withBits(receiver::CodeConfig code, const std::vector<types::Sonar>& pings) {
    float maximum = 255;
    for (const types::Sonar& ping : pings)
        for (const float bin : ping.bins) maximum = std::max(maximum, bin);
    code.bits = std::min(16, static_cast<int>(std::ceil(std::log2(maximum + 1))));
    return code;
}

/** Returns the pings of a fan. */
std::vector<CodedPing> pingsOfFan(RecordingReader& reader, const receiver::CodeConfig& assumed) {
    std::vector<CodedPing> pings;
    for (auto recorded = reader.next(); recorded; recorded = reader.next()) {
        receiver::CodeConfig law = recorded->law_known ? recorded->code : assumed;
        law.bits = recorded->code.bits;
        const double factor = (std::exp2(law.bits) - 1) / recorded->max_code;
        if (factor != 1)
            for (float& bin : recorded->ping.bins) bin = static_cast<float>(static_cast<double>(bin) * factor);
        CodedPing& coded =
            pings.emplace_back(codedPing(recorded->ping, law, fmt::format("recorded_{}", recorded->number)));
        coded.law_known = recorded->law_known;
        coded.speed_of_sound = recorded->speed_of_sound;
        coded.frequency_khz = recorded->frequency_khz;
    }
    return pings;
}

/** Returns the lines of a side-scan as a waterfall for each side. */
std::vector<CodedPing> pingsOfLines(RecordingReader& reader, const receiver::CodeConfig& law) {
    std::vector<types::Sonar> lines;
    std::vector<types::Pose> sonars;
    std::vector<double> altitudes;
    double frequency_khz = 0;
    for (auto line = reader.next(); line; line = reader.next()) {
        frequency_khz = line->frequency_khz;
        sonars.push_back(line->sonar);
        altitudes.push_back(line->altitude);
        lines.push_back(std::move(line->ping));
    }
    std::vector<CodedPing> sides = codedLines(lines, withBits(law, lines), "recorded", getPlaces(sonars, altitudes));
    for (CodedPing& side : sides) side.law_known = false, side.frequency_khz = frequency_khz;
    return sides;
}

bool isLineOfSideScan(const types::Sonar& ping) {
    return ping.beam_count == 2 && ping.bearings.size() == 2 && ping.bearings[0].rad < -1.5 &&
           ping.bearings[1].rad > 1.5;
}

std::vector<CodedPing> pingsOfLog(const LoggedPings& log, const receiver::CodeConfig& law) {
    const receiver::CodeConfig code = log.law_known ? log.code : withBits(law, log.pings);
    std::vector<CodedPing> pings;
    if (isLineOfSideScan(log.pings.front()))
        pings = codedLines(log.pings, code, "recorded", getPlaces(log.sonars, log.altitudes));
    else
        for (const types::Sonar& ping : log.pings)
            pings.push_back(codedPing(ping, code, fmt::format("recorded_{}", pings.size())));
    for (CodedPing& ping : pings) ping.law_known = log.law_known, ping.frequency_khz = log.frequency_khz;
    return pings;
}

/** Returns the pings of a recording. Throws types::ConfigError for pings of one beam. */
std::vector<CodedPing> pingsOfRecording(const fs::path& file, const receiver::CodeConfig& assumed) {
    const auto reader = RecordingReader::open(file);
    if (reader->shape() == recordings::RecordedShape::Scan || reader->shape() == recordings::RecordedShape::Sounder)
        throw types::ConfigError(file.string(), "--real",
                                 fmt::format("is a recording of {}, whose pings have one beam; fans and side-scans can "
                                             "be compared. `insonify log import` makes a log of it, whose pings "
                                             "`insonify replay --rerender --score` compares",
                                             reader->format().device));
    try {
        return codedPings(*reader, assumed);
    } catch (const types::ConfigError& error) {
        if (!reader->format().signature.empty()) throw;
        throw types::ConfigError(file.string(), "--real",
                                 fmt::format("{}; what is read: {} recordings, logs of pings, and .png pictures",
                                             error.diagnostics().front().message, recordings::recordingEndings()));
    }
}

/** Returns the ping of a picture. */
std::vector<CodedPing> pingsOfPicture(const fs::path& file, const receiver::CodeConfig& assumed,
                                      const PictureConfig* pictures) {
    if (!pictures)
        throw types::ConfigError(file.string(), "--real", "is a picture, which `insonify fit` reads; give recordings");
    return {readPicture(file, *pictures, assumed)};
}

/** Values of lines; none if unknown. */
using Known = std::vector<std::optional<double>>;

/** Returns a value for each line: linear between lines at which the value changes, constant before the first and after
 *  the last of these. Empty if no value is known. */
std::vector<double> spread(const Known& known) {
    std::vector<size_t> fresh;
    for (size_t i = 0; i < known.size(); ++i)
        if (known[i] && (fresh.empty() || *known[i] != *known[fresh.back()])) fresh.push_back(i);
    if (fresh.empty()) return {};
    std::vector<double> values(known.size(), *known[fresh.back()]);
    for (size_t i = 0; i < fresh.front(); ++i) values[i] = *known[fresh.front()];
    for (size_t k = 0; k + 1 < fresh.size(); ++k)
        for (size_t i = fresh[k]; i < fresh[k + 1]; ++i)
            values[i] = std::lerp(*known[fresh[k]], *known[fresh[k + 1]],
                                  static_cast<double>(i - fresh[k]) / static_cast<double>(fresh[k + 1] - fresh[k]));
    return values;
}

/** Returns the distance along the track since the first line; beyond the known places it is extrapolated by the
 *  mean. */
std::vector<double> computeAlong(const std::vector<types::Pose>& sonars) {
    Known known(sonars.size());
    std::optional<glm::dvec3> before;
    double along = 0;
    size_t first = 0, last = 0;
    for (size_t i = 0; i < sonars.size(); ++i) {
        if (!types::isUsable(sonars[i])) continue;
        const glm::dvec3 here = sonars[i].position;
        const double step = before ? std::hypot(here.x - before->x, here.y - before->y) : 0;
        if (!before) first = i;
        if (!before || step > 0) last = i;
        along += step;
        before = here;
        known[i] = along;
    }
    std::vector<double> way = spread(known);
    if (last == first) return way;
    const double mean = along / static_cast<double>(last - first);
    for (size_t i = 0; i < way.size(); ++i) {
        if (i < first) way[i] -= mean * static_cast<double>(first - i);
        if (i > last) way[i] += mean * static_cast<double>(i - last);
    }
    return way;
}

}  // namespace

std::vector<LinePlace> getPlaces(const std::vector<types::Pose>& sonars, const std::vector<double>& altitudes) {
    Known heights, pitches;
    for (const double altitude : altitudes)
        heights.push_back(altitude > 0 ? std::optional<double>(altitude) : std::nullopt);
    for (const types::Pose& pose : sonars)
        pitches.push_back(types::isUsable(pose)
                              ? std::optional<double>(types::toTurns(glm::normalize(pose.orientation)).pitch)
                              : std::nullopt);
    const std::vector<double> height = spread(heights), pitch = spread(pitches), along = computeAlong(sonars);
    if (height.empty() && pitch.empty()) return {};
    std::vector<LinePlace> places(std::max(height.size(), pitch.size()));
    for (size_t i = 0; i < height.size(); ++i) places[i].altitude = height[i];
    for (size_t i = 0; i < pitch.size(); ++i) places[i].pitch = pitch[i], places[i].along = along[i];
    return places;
}

double CodedPing::levelDb(float code) const {
    const double minimum = 0.5 / (std::pow(2, bits) - 1), share = std::max(minimum, static_cast<double>(code));
    if (law.law == receiver::CodeLaw::Log) return (share - 1) * law.dynamic_range_db;
    return (law.law == receiver::CodeLaw::Sqrt ? 20 : 10) * std::log10(share) / law.gamma;
}

CodedPing codedPing(const types::Sonar& ping, const receiver::CodeConfig& code, std::string name) {
    CodedPing coded{.name = std::move(name),
                    .beam_count = 0,
                    .bin_count = ping.bin_count,
                    .bearings = {},
                    .codes = {},
                    .bits = code.bits,
                    .law = code,
                    .resolution = ping.binStart(1),
                    .speed_of_sound = static_cast<double>(ping.speed_of_sound)};
    const types::BeamArc arc(ping);  // neighbouring rows are neighbouring beams
    coded.beam_count = static_cast<uint32_t>(arc.beams.size());
    for (const uint32_t beam : arc.beams) {
        coded.bearings.push_back(ping.bearings[beam].rad);
        const auto bins = ping.bins.begin() + static_cast<std::ptrdiff_t>(size_t{beam} * ping.bin_count);
        coded.codes.insert(coded.codes.end(), bins, bins + ping.bin_count);
    }
    for (float& each : coded.codes) each /= static_cast<float>((1 << code.bits) - 1);
    return coded;
}

std::vector<CodedPing> codedLines(const std::vector<types::Sonar>& lines, const receiver::CodeConfig& code,
                                  const std::string& name, const std::vector<LinePlace>& places) {
    std::vector<CodedPing> sides;
    for (const double side : {-1.0, 1.0}) {
        CodedPing picture{.name = name + (side < 0 ? "_starboard" : "_port"),
                          .bin_count = lines.front().bin_count,
                          .bits = code.bits,
                          .law = code,
                          .resolution = lines.front().binStart(1),
                          .speed_of_sound = static_cast<double>(lines.front().speed_of_sound),
                          .is_waterfall = true};
        const auto maximum = static_cast<float>((1 << code.bits) - 1);
        for (size_t i = 0; i < lines.size(); ++i)
            for (size_t beam = 0; beam < lines[i].beam_count; ++beam) {
                const types::Sonar& line = lines[i];
                if (line.bin_count != picture.bin_count || line.bearings[beam].rad * side <= 0) continue;
                for (size_t bin = 0; bin < line.bin_count; ++bin)
                    picture.codes.push_back(line.bins[beam * line.bin_count + bin] / maximum);
                if (!places.empty()) picture.places.push_back(places[i]);
                picture.bearings.push_back(side * static_cast<double>(++picture.beam_count));
            }
        if (picture.beam_count > 0) sides.push_back(std::move(picture));
    }
    return sides;
}

std::vector<CodedPing> codedPings(RecordingReader& reader, const receiver::CodeConfig& assumed) {
    return reader.shape() == recordings::RecordedShape::Line ? pingsOfLines(reader, assumed)
                                                             : pingsOfFan(reader, assumed);
}

std::vector<CodedPing> recordedPings(const std::vector<std::string>& names, const receiver::CodeConfig* law,
                                     const ReadLog& readLog, const PictureConfig* pictures) {
    const receiver::CodeConfig assumed = law ? *law : receiver::CodeConfig{.law = receiver::CodeLaw::Sqrt};
    std::vector<CodedPing> pings;
    for (const fs::path& file : getFiles(names, pictures != nullptr)) {
        const bool is_picture = isPicture(file);
        const std::optional<LoggedPings> logged = readLog && !is_picture ? readLog(file) : std::nullopt;
        for (CodedPing& coded : is_picture ? pingsOfPicture(file, assumed, pictures)
                                : logged   ? pingsOfLog(*logged, assumed)
                                           : pingsOfRecording(file, assumed)) {
            coded.file = file.string();
            const auto isSame = [&](const CodedPing& other) {
                return other.name == coded.name && other.codes == coded.codes;
            };
            if (std::ranges::none_of(pings, isSame)) pings.push_back(std::move(coded));
        }
    }
    if (pings.empty()) throw types::ConfigError(names.front(), "--real", "is a folder without a recording");
    return pings;
}

}  // namespace insonify::study
