// insonify study likeness [DEPLOYMENT] --real FILES
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "components/command/Json.hpp"
#include "components/command/OutputFolder.hpp"
#include "components/study/CodedPing.hpp"
#include "components/study/LikenessReport.hpp"
#include "components/study/commands/StudyCommand.hpp"

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

int runStudy(const RecordingOptions& options, const FindPing& pingAt) {
    const std::vector<CodedPing> recorded = recordedPings(options.real);
    std::optional<CodedPing> simulated;
    if (!options.deployment.empty()) {
        const PingAt found = pingAt(options.deployment, options.ping);
        simulated = codedPing(found.ping, found.code, "simulated");
    }
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

void addLikenessStudy(CLI::App& study, command::Action& action, const FindPing& pingAt) {
    const auto options = std::make_shared<RecordingOptions>();
    CLI::App* command = study.add_subcommand("likeness", "How like recordings of a real sonar simulated pings look");
    options->addTo(*command, "a YAML file whose receiver gives out codes; absent: what the recordings look like")
        ->required();
    command->callback(
        [options, pingAt, &action] { action = [options, pingAt] { return runStudy(*options, pingAt); }; });
}

}  // namespace insonify::study
