// insonify study speckle [DEPLOYMENT]
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "components/console/Console.hpp"
#include "components/console/Json.hpp"
#include "components/console/OutputFolder.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/study/CodedPing.hpp"
#include "components/study/SpeckleStudy.hpp"
#include "components/study/StudyScene.hpp"
#include "components/study/commands/StudyCommand.hpp"

namespace insonify::study {
namespace {

using console::Json;

Json toJson(const SpeckleRow& row) {
    Json json{{"name", row.name}, {"loudest", row.loudest}, {"slices", Json::array()}};
    for (const SpeckleSlice& slice : row.slices) {
        Json each{{"slice", slice.slice},
                  {"bin_correlations", slice.figures.along},
                  {"beam_correlations", slice.figures.across}};
        for (const SpeckleFigure& figure : computeFigures(slice)) each[figure.name] = figure.value;
        json["slices"].push_back(std::move(each));
    }
    return json;
}

Json toJson(const std::vector<SpeckleRow>& rows, const std::vector<Claim>& claims) {
    Json json{{"pings", Json::array()}, {"verdicts", getVerdicts(claims)}};
    for (const SpeckleRow& row : rows) json["pings"].push_back(toJson(row));
    return json;
}

void printTable(const std::vector<SpeckleRow>& rows) {
    console::printResult("{:<22}", "where it is loudest");
    for (const SpeckleRow& row : rows) console::printResult(" {:>16}", row.name);
    const auto names = computeFigures(SpeckleSlice{});
    for (size_t i = 0; i < names.size(); ++i) {
        console::printResult("\n{:<22}", names[i].name);
        for (const SpeckleRow& row : rows) {
            const SpeckleSlice* loud = row.loudestSlice();
            console::printResult(" {:>16}",
                                 loud ? fmt::format("{:.4g}", computeFigures(*loud)[i].value) : "too few bins");
        }
    }
    console::printResult("\n");
}

/** Prints the claims; returns whether none fails. */
bool printClaims(const std::vector<Claim>& claims) {
    for (const Claim& claim : claims)
        console::printResult("{}  {}: {:.3g}, {} {:.4g}\n", claim.verdict(), claim.text, claim.measured,
                             claim.at_most ? "at most" : "at least", claim.bound);
    return std::ranges::none_of(claims, &Claim::fails);
}

std::vector<SpeckleRow> recordedRows(const std::vector<std::string>& real) {
    std::vector<SpeckleRow> rows;
    if (real.empty()) return rows;
    const std::vector<CodedPing> pings = recordedPings(real, nullptr, readLog);
    for (size_t i = 0; i < pings.size(); ++i) {
        const CodedPing* next = i + 1 < pings.size() ? &pings[i + 1] : nullptr;
        const bool follows = next && next->file == pings[i].file && next->beam_count == pings[i].beam_count &&
                             next->bin_count == pings[i].bin_count && !next->is_waterfall;
        rows.push_back(speckleRow(pings[i], follows ? next : nullptr));
    }
    return rows;
}

/** Returns the sonar over the flat bottom of the study of the error. */
deployer::SonarAt ownSonar() {
    const StudyScene scene =
        std::ranges::find(closedFormScenes(), std::string("flat_bottom"), &SceneMaker::name)->make();
    return {scene.config, scene.snapshot};
}

int runStudy(const RecordingOptions& options) {
    std::vector<SpeckleRow> rows = recordedRows(options.real);
    std::vector<Claim> claims = lawClaims();
    for (const Claim& claim : coherentClaims()) claims.push_back(claim);
    for (const Claim& claim : recordedClaims(rows)) claims.push_back(claim);
    const deployer::SonarAt found =
        options.deployment.empty() ? ownSonar() : deployer::sonarAt(options.deployment, options.ping);
    for (SpeckleRow& row : simulatedRows(found.config, found.snapshot)) rows.push_back(std::move(row));
    console::OutputFolder folder(options.out, "study_speckle");
    folder.keep();
    writeReport(rows, folder.path());
    console::write(toJson(rows, claims), (folder.path() / "speckle.json").string());
    printTable(rows);
    const bool all_hold = printClaims(claims);
    console::printResult("report in {}\n", folder.path().string());
    return all_hold ? 0 : 1;
}

}  // namespace

void addSpeckleStudy(CLI::App& study, console::Action& action) {
    const auto options = std::make_shared<RecordingOptions>();
    CLI::App* command = study.add_subcommand("speckle", "Statistics of speckle, simulated and recorded");
    options->addTo(*command, "a YAML file whose sonar and scene are studied; absent: a fan over a flat bottom");
    command->callback([options, &action] { action = [options] { return runStudy(*options); }; });
}

}  // namespace insonify::study
