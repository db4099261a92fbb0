// insonify study likeness [DEPLOYMENT] --real FILES
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "components/console/Console.hpp"
#include "components/console/Json.hpp"
#include "components/console/OutputFolder.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/study/CodedPing.hpp"
#include "components/study/commands/StudyCommand.hpp"
#include "components/study/likeness/Likeness.hpp"
#include "types/text/ConfigError.hpp"

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
    std::string lines = "deployment", side;
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

int runStudy(const LikenessOptions& options) {
    std::optional<receiver::CodeConfig> law;
    if (!options.deployment.empty()) law = deployer::codedPingsAt(options.deployment, 1, 1, options.set).code;
    const std::vector<CodedPing> recorded =
        ofOneKind(recordedPings(options.real, law ? &*law : nullptr, readLog), options.side);
    std::optional<CodedPing> simulated;
    if (law) simulated = simulatedLike(recorded.front(), options);
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
    options->addTo(*command, "a YAML file whose receiver outputs codes; absent: statistics of the recordings only")
        ->required();
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
    command->callback([options, &action] { action = [options] { return runStudy(*options); }; });
}

}  // namespace insonify::study
