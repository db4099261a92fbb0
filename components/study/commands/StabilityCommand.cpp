// insonify study stability --out DIR
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "components/command/ProgressLine.hpp"
#include "components/study/StabilityStudy.hpp"
#include "components/study/commands/StudyCommand.hpp"
#include "types/ConfigError.hpp"

namespace insonify::study {
namespace {

void makeFolder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw types::ConfigError("", "--out", fmt::format("{} cannot be made: {}", folder.string(), error.message()));
}

void printRow(const StabilityRow& row) {
    const Outcome& outcome = row.outcome;
    fmt::print("{:>3}  {:<7}  {:>8}  {}\n", row.number, nameOf(outcome.verdict),
               isJudged(outcome) ? fmt::format("{:.1e}", outcome.deviation) : "", row.name);
    if (outcome.verdict == Verdict::Fail) fmt::print("     expected: {}\n     got: {}\n", row.expected, outcome.got);
    if (outcome.verdict == Verdict::NotRun) fmt::print("     {}\n", outcome.got);
    std::fflush(stdout);
}

int runStudy(const std::filesystem::path& folder) {
    makeFolder(folder);
    std::vector<StabilityCase> cases = stabilityCases();
    fmt::print("case  verdict    deviation\n");
    command::StudyProgress progress(true, cases.size());
    const std::vector<StabilityRow> rows = studyStability(std::move(cases), [&](const StabilityRow& row) {
        progress.end();
        printRow(row);
        progress.advance();
        progress("cases");
    });
    progress.end();
    writeStability(rows, folder);
    fmt::print("{}; {} and stability.json\n", tally(rows), (folder / "stability.md").string());
    const auto failed = [](const StabilityRow& row) { return row.outcome.verdict == Verdict::Fail; };
    return std::ranges::any_of(rows, failed) ? 1 : 0;
}

}  // namespace

void addStabilityStudy(CLI::App& study, command::Action& action) {
    const auto folder = std::make_shared<std::string>();
    CLI::App* command = study.add_subcommand("stability", "Runs stiff and extreme cases and judges each");
    command->add_option("--out", *folder, "folder for stability.md and stability.json")->required();
    command->callback([folder, &action] { action = [folder] { return runStudy(*folder); }; });
}

}  // namespace insonify::study
