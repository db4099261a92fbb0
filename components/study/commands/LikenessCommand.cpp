// insonify study likeness [DEPLOYMENT] --real FILES
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "components/command/Json.hpp"
#include "components/command/OutputFolder.hpp"
#include "components/study/CodedPing.hpp"
#include "components/study/LikenessReport.hpp"
#include "components/study/commands/StudyCommand.hpp"
#include "types/ConfigError.hpp"

namespace insonify::study {
namespace {

using command::Json;

Json toJson(const LikenessRow& row) {
    Json json{{"name", row.name}};
    for (const LikenessFigure& figure : figuresOf(row)) json[figure.name] = figure.value;
    json["histogram"] = row.looks.histogram;
    json["mean_code_by_range"] = row.looks.mean_code;
    json["level_db_by_range"] = row.looks.level_db;
    return json;
}

Json toJson(const LikenessResult& result) {
    Json json{{"pings", Json::array()}, {"verdicts", Json::array()}};
    for (const LikenessRow& row : result.rows) json["pings"].push_back(toJson(row));
    const LikenessRow* simulated = result.row("simulated");
    if (simulated) json["verdicts"] = verdictsOf(claims(simulated->apart, result.recorded));
    return json;
}

void printTable(const LikenessResult& result) {
    fmt::print("{:<18}", "");
    for (const LikenessRow& row : result.rows) fmt::print(" {:>15}", row.name);
    const auto first = figuresOf(result.rows.front());
    for (size_t i = 0; i < first.size(); ++i) {
        fmt::print("\n{:<18}", first[i].name);
        for (const LikenessRow& row : result.rows) fmt::print(" {:>15.4g}", figuresOf(row)[i].value);
    }
    fmt::print("\n");
}

/** Whether none fails. */
bool printClaims(const LikenessResult& result) {
    const LikenessRow* simulated = result.row("simulated");
    if (!simulated) return true;
    const std::vector<Claim> all = claims(simulated->apart, result.recorded),
                             uniform = claims(result.row("uniform")->apart, result.recorded),
                             cosine = claims(result.row("cosine")->apart, result.recorded);
    for (size_t i = 0; i < all.size(); ++i)
        fmt::print("{}  {}: {:.3g}, at most {:.3g} (a uniform picture {:.3g}, a cosine {:.3g})\n", all[i].verdict(),
                   all[i].text, all[i].measured, all[i].bound, uniform[i].measured, cosine[i].measured);
    if (std::ranges::any_of(all, [](const Claim& claim) { return !claim.holds() && !claim.fails(); }))
        fmt::print("open: the recordings show no arc to compare with\n");
    return std::ranges::none_of(all, &Claim::fails);
}

/** What the deployment makes of a recording's kind: a ping, or as many lines of a side-scan as a waterfall has. */
CodedPing simulatedLike(const CodedPing& recorded, const RecordingOptions& options, const FindPings& pingsAt) {
    const size_t count = recorded.is_waterfall ? recorded.beam_count : 1;
    const PingsAt found = pingsAt(options.deployment, options.ping, count);
    if (!recorded.is_waterfall) return codedPing(found.pings.front(), found.code, "simulated");
    for (CodedPing& side : codedLines(found.pings, found.code, "simulated"))
        if (side.bearings.front() * recorded.bearings.front() > 0) {
            side.name = "simulated";
            return side;
        }
    throw types::ConfigError(options.deployment, "tasks",
                             "have no side-scan with this side, which the recording is of");
}

/** Recorded pings of one kind: of a side-scan the starboard lines, or all that there are. */
std::vector<CodedPing> ofOneKind(std::vector<CodedPing> recorded) {
    if (!recorded.front().is_waterfall) return recorded;
    std::erase_if(recorded, [&](const CodedPing& ping) { return ping.name != recorded.front().name; });
    return recorded;
}

int runStudy(const RecordingOptions& options, const FindPings& pingsAt, const ReadLog& readLog) {
    std::optional<receiver::CodeConfig> law;
    if (!options.deployment.empty()) law = pingsAt(options.deployment, 1, 1).code;
    const std::vector<CodedPing> recorded = ofOneKind(recordedPings(options.real, law ? &*law : nullptr, readLog));
    std::optional<CodedPing> simulated;
    if (law) simulated = simulatedLike(recorded.front(), options, pingsAt);
    const LikenessResult result = studyLikeness(recorded, simulated ? &*simulated : nullptr);
    command::OutputFolder folder(options.out, "study_likeness");
    folder.keep();
    writeReport(result, folder.path());
    command::write(toJson(result), (folder.path() / "likeness.json").string());
    printTable(result);
    const bool all_hold = printClaims(result);
    fmt::print("report in {}\n", folder.path().string());
    return all_hold ? 0 : 1;
}

}  // namespace

void addLikenessStudy(CLI::App& study, command::Action& action, const FindPings& pingsAt, const ReadLog& readLog) {
    const auto options = std::make_shared<RecordingOptions>();
    CLI::App* command = study.add_subcommand("likeness", "How like recordings of a real sonar simulated pings look");
    options->addTo(*command, "a YAML file whose receiver gives out codes; absent: what the recordings look like")
        ->required();
    command->callback([options, pingsAt, readLog, &action] {
        action = [options, pingsAt, readLog] { return runStudy(*options, pingsAt, readLog); };
    });
}

}  // namespace insonify::study
