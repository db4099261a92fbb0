// insonify study likeness [DEPLOYMENT] --real FILES, insonify study likeness --objects FOLDER
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "components/console/Console.hpp"
#include "components/console/Json.hpp"
#include "components/console/OutputFolder.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/output/PictureFiles.hpp"
#include "components/study/CodedPing.hpp"
#include "components/study/commands/StudyCommand.hpp"
#include "components/study/likeness/Likeness.hpp"
#include "components/study/likeness/ObjectLooks.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::study {
namespace {

using console::Json;

Json toJson(const LikenessRow& row) {
    Json json{{"name", row.name}};
    for (const LikenessFigure& figure : computeFigures(row)) json[figure.name] = figure.value;
    json["histogram"] = row.looks.histogram;
    json["mean_code_by_range"] = row.looks.mean_code;
    json["level_db_by_range"] = row.looks.level_db;
    return json;
}

Json toJson(const LikenessResult& result) {
    Json json{{"pings", Json::array()}, {"verdicts", Json::array()}};
    for (const LikenessRow& row : result.rows) json["pings"].push_back(toJson(row));
    const LikenessRow* simulated = result.row("simulated");
    if (simulated) json["verdicts"] = getVerdicts(claims(simulated->apart, result.recorded));
    return json;
}

void printTable(const LikenessResult& result) {
    console::printResult("{:<18}", "");
    for (const LikenessRow& row : result.rows) console::printResult(" {:>15}", row.name);
    const auto first = computeFigures(result.rows.front());
    for (size_t i = 0; i < first.size(); ++i) {
        console::printResult("\n{:<18}", first[i].name);
        for (const LikenessRow& row : result.rows) console::printResult(" {:>15.4g}", computeFigures(row)[i].value);
    }
    console::printResult("\n");
}

/** Prints the claims; returns whether none fails. */
bool printClaims(const LikenessResult& result) {
    const LikenessRow* simulated = result.row("simulated");
    if (!simulated) return true;
    const std::vector<Claim> all = claims(simulated->apart, result.recorded),
                             uniform = claims(result.row("uniform")->apart, result.recorded),
                             cosine = claims(result.row("cosine")->apart, result.recorded);
    for (size_t i = 0; i < all.size(); ++i)
        console::printResult("{}  {}: {:.3g}, at most {:.3g} (a uniform picture {:.3g}, a cosine {:.3g})\n",
                             all[i].verdict(), all[i].text, all[i].measured, all[i].bound, uniform[i].measured,
                             cosine[i].measured);
    if (std::ranges::any_of(all, [](const Claim& claim) { return !claim.holds() && !claim.fails(); }))
        console::printResult("open: the recordings show no arc to compare with\n");
    return std::ranges::none_of(all, &Claim::fails);
}

struct LikenessOptions : RecordingOptions {
    std::string lines = "deployment", side, objects;
    std::vector<std::string> set;
};

/** Returns the settings that place the deployment's lines at those of a recording. */
std::vector<std::string> recordedSettings(const CodedPing& recorded, const LikenessOptions& options) {
    if (!recorded.is_waterfall)
        throw types::ConfigError(recorded.file, "--lines", "is recorded; the recording is not of a side-scan");
    if (recorded.places.empty())
        throw types::ConfigError(recorded.file, "--lines",
                                 "is recorded; the recording states neither places nor altitudes");
    ChainAt at = chainAt(options.deployment, options.ping, options.set);
    layLines(recorded, at.chain);
    std::vector<std::string> settings;
    for (const FitSetting& setting : getFoundSettings(at.chain, at.tasks))
        settings.push_back(setting.path + "=" + setting.value);
    return settings;
}

/** Returns the deployment's simulation of a recording: a ping, or the number of lines of its waterfall. */
CodedPing simulatedLike(const CodedPing& recorded, const LikenessOptions& options) {
    const size_t count = recorded.is_waterfall ? recorded.beam_count : 1;
    std::vector<std::string> settings = options.set;
    if (options.lines == "recorded") {
        const std::vector<std::string> way = recordedSettings(recorded, options);
        settings.insert(settings.end(), way.begin(), way.end());
    }
    const deployer::PingsAt found = deployer::codedPingsAt(options.deployment, options.ping, count, settings);
    if (!recorded.is_waterfall) return codedPing(found.pings.front(), found.code, "simulated");
    for (CodedPing& side : codedLines(found.pings, found.code, "simulated"))
        if (side.bearings.front() * recorded.bearings.front() > 0) {
            side.name = "simulated";
            return side;
        }
    throw types::ConfigError(options.deployment, "tasks", "have no side-scan with the side of the recording");
}

/** Returns recorded pings of one kind: for a side-scan the lines of one side. */
std::vector<CodedPing> ofOneKind(std::vector<CodedPing> recorded, const std::string& side) {
    if (!recorded.front().is_waterfall) return recorded;
    const std::string file = recorded.front().file;
    const bool is_starboard = side.empty() ? recorded.front().bearings.front() < 0 : side == "starboard";
    std::erase_if(recorded, [&](const CodedPing& ping) {
        return !ping.is_waterfall || (ping.bearings.front() < 0) != is_starboard;
    });
    if (recorded.empty()) throw types::ConfigError(file, "--side", "is " + side + ", which has no lines");
    return recorded;
}

/** Returns the picture of a file as a crop. */
ObjectCrop readCrop(const std::filesystem::path& file) try {
    types::Image image = output::readPng(file);
    return {file.stem().string(), image.size.width, image.size.height, std::move(image.image)};
} catch (const std::runtime_error& error) {
    throw types::ConfigError(file.string(), "--objects", error.what());
}

/** Returns whether a pixel of a sample's picture is within its fan. */
bool isInFan(const Json& record, double column, double row) {
    const double port = record["picture"]["width"].get<double>() / 2 - 0.5 - column;
    const double radius = record["picture"]["height"].get<double>(), ahead = radius - 0.5 - row;
    const auto bearings = record["ping"]["bearing_rad"].get<std::array<double, 2>>();
    const double bearing = std::atan2(port, ahead);
    return std::hypot(port, ahead) <= radius && bearing >= std::min(bearings[0], bearings[1]) &&
           bearing <= std::max(bearings[0], bearings[1]);
}

/** Adds a window about each object of a data set's sample that is within the fan. */
void addCrops(const std::filesystem::path& file, std::vector<ObjectCrop>& crops) {
    std::ifstream stream(file, std::ios::binary);
    const Json record = console::readJson(std::string(std::istreambuf_iterator<char>(stream), {}), 16);
    if (!record.is_object() || !record.contains("annotations") || record["picture"]["shape"] != "fan") return;
    const ObjectCrop whole = readCrop(std::filesystem::path(file).replace_extension(".png"));
    if (whole.width < crop_side || whole.height < crop_side) return;
    for (const Json& annotation : record["annotations"]) {
        const auto box = annotation["bbox"].get<std::array<double, 4>>();
        if (annotation.value("shadow", false) || box[2] > crop_side || box[3] > crop_side) continue;
        const auto from = [](double middle, size_t length) {
            return static_cast<size_t>(
                std::clamp(middle - crop_side / 2.0, 0.0, static_cast<double>(length - crop_side)));
        };
        const size_t left = from(box[0] + box[2] / 2, whole.width), top = from(box[1] + box[3] / 2, whole.height);
        const auto right = static_cast<double>(left + crop_side - 1), bottom = static_cast<double>(top + crop_side - 1);
        const auto x = static_cast<double>(left), y = static_cast<double>(top);
        if (!isInFan(record, x, y) || !isInFan(record, right, y) || !isInFan(record, x, bottom) ||
            !isInFan(record, right, bottom))
            continue;
        ObjectCrop& crop = crops.emplace_back();
        crop = {fmt::format("{}_{}", whole.name, annotation["name"].get<std::string>()), crop_side, crop_side, {}};
        for (size_t row = 0; row < crop_side; ++row)
            for (size_t column = 0; column < crop_side; ++column)
                crop.levels.push_back(whole.at(left + column, top + row));
    }
}

/** Returns the crops of a folder: windows about the objects of a data set, else its pictures as they are. */
std::vector<ObjectCrop> readCrops(const std::filesystem::path& folder) {
    std::error_code error;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) files.push_back(entry.path());
    if (error) throw types::ConfigError(folder.string(), "--objects", "cannot be read: " + error.message());
    std::ranges::sort(files);
    const bool is_set = std::filesystem::exists(folder / "dataset.json");
    std::vector<ObjectCrop> crops;
    for (const std::filesystem::path& file : files) {
        const bool is_record = file.extension() == ".json" && types::isDigit(file.filename().string().front());
        if (is_set && is_record) addCrops(file, crops);
        if (!is_set && file.extension() == ".png") crops.push_back(readCrop(file));
    }
    if (crops.empty())
        throw types::ConfigError(
            folder.string(), "--objects",
            fmt::format("has no {}; it may be a data set of fans (coco, yolo, mask) or a folder of "
                        "crops as .png",
                        is_set ? "object whose window of 96 x 96 px is within the fan" : "picture"));
    return crops;
}

int studyObjects(const LikenessOptions& options) {
    const std::vector<ObjectCrop> crops = readCrops(options.objects);
    std::vector<ObjectLooks> all;
    for (const ObjectCrop& crop : crops) all.push_back(computeLooks(crop));
    const ObjectLooks median = computeMedian(all);
    const std::vector<Claim> found = claims(median, crops.size());
    console::OutputFolder folder(options.out, "study_likeness");
    folder.keep();
    std::ofstream table(folder.path() / "objects.csv");
    if (!(table << csv(crops, all) << std::flush)) throw std::runtime_error("objects.csv cannot be written");
    Json json{{"crops", crops.size()}, {"verdicts", getVerdicts(found)}};
    for (const ObjectFigure& figure : getFigures(median))
        json["figures"][figure.name] = {
            {"median", figure.value}, {"real", figure.real}, {"tolerance", figure.tolerance}};
    console::write(json, (folder.path() / "objects.json").string());
    console::printResult("{} crops; the median of each figure\n", crops.size());
    for (const Claim& claim : found)
        console::printResult("{}  {}: {:.3g}, at most {:.3g}\n", claim.verdict(), claim.text, claim.measured,
                             claim.bound);
    console::printResult("report in {}\n", folder.path().string());
    return std::ranges::none_of(found, &Claim::fails) ? 0 : 1;
}

int runStudy(const LikenessOptions& options) {
    if (!options.objects.empty()) return studyObjects(options);
    std::optional<receiver::CodeConfig> law;
    if (!options.deployment.empty()) law = deployer::codedPingsAt(options.deployment, 1, 1, options.set).code;
    const std::vector<CodedPing> recorded =
        ofOneKind(recordedPings(options.real, law ? &*law : nullptr, readLog), options.side);
    std::optional<CodedPing> simulated;
    if (law) simulated = simulatedLike(recorded.front(), options);
    if (simulated) simulated->file = options.deployment;
    const LikenessResult result = studyLikeness(recorded, simulated ? &*simulated : nullptr);
    console::OutputFolder folder(options.out, "study_likeness");
    folder.keep();
    writeReport(result, folder.path());
    console::write(toJson(result), (folder.path() / "likeness.json").string());
    printTable(result);
    const bool all_hold = printClaims(result);
    console::printResult("report in {}\n", folder.path().string());
    return all_hold ? 0 : 1;
}

}  // namespace

void addLikenessStudy(CLI::App& study, console::Action& action) {
    const auto options = std::make_shared<LikenessOptions>();
    CLI::App* command = study.add_subcommand("likeness", "Compares simulated pings with recordings of a real sonar");
    CLI::Option* const real =
        options->addTo(*command, "a YAML file whose receiver outputs codes; absent: statistics of the recordings only");
    CLI::Option* const objects = command->add_option(
        "--objects", options->objects,
        "instead: a data set of fans, or a folder of crops (.png, far ranges on top), whose figures "
        "are compared with those of real crops of objects");
    objects->excludes(real);
    command
        ->add_option("--side", options->side,
                     "side of a side-scan whose lines are compared; default: starboard, if it has lines")
        ->check(CLI::IsMember({"starboard", "port"}));
    command
        ->add_option(
            "--lines", options->lines,
            "lines of a side-scan. deployment: along its vehicle's track; recorded: a straight track, as high above "
            "the floor and pitched as the recording states")
        ->check(CLI::IsMember({"deployment", "recorded"}));
    command->add_option("--set", options->set,
                        "task.property.path=value: a property other than in the file; may be repeated");
    command->callback([options, &action] {
        if (options->real.empty() && options->objects.empty()) throw CLI::RequiredError("--real or --objects");
        action = [options] { return runStudy(*options); };
    });
}

}  // namespace insonify::study
