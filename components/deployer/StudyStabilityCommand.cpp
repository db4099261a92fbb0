// insonify study stability --out DIR
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "components/deployer/ProgressLine.hpp"
#include "components/deployer/StabilityTasks.hpp"
#include "components/deployer/StudyCommand.hpp"
#include "types/ConfigError.hpp"

namespace insonify::deployer {
namespace {

using study::StabilityRow;
using study::Verdict;

void makeFolder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw types::ConfigError("", "--out", fmt::format("{} cannot be made: {}", folder.string(), error.message()));
}

void printRow(const StabilityRow& row) {
    const study::Outcome& outcome = row.outcome;
    fmt::print("{:>3}  {:<7}  {:>8}  {}\n", row.number, nameOf(outcome.verdict),
               study::isJudged(outcome) ? fmt::format("{:.1e}", outcome.deviation) : "", row.name);
    if (outcome.verdict == Verdict::Fail) fmt::print("     expected: {}\n     got: {}\n", row.expected, outcome.got);
    if (outcome.verdict == Verdict::NotRun) fmt::print("     {}\n", outcome.got);
    std::fflush(stdout);
}

int studyStability(const std::filesystem::path& folder) {
    makeFolder(folder);
    std::vector<study::StabilityCase> cases = study::stabilityCases();
    for (study::StabilityCase& added : taskStabilityCases()) cases.push_back(std::move(added));
    fmt::print("case  verdict    deviation\n");
    StudyProgress progress(true, cases.size());
    const std::vector<StabilityRow> rows = study::studyStability(std::move(cases), [&](const StabilityRow& row) {
        progress.end();
        printRow(row);
        progress.advance();
        progress("cases");
    });
    progress.end();
    study::writeStability(rows, folder);
    fmt::print("{}; {} and stability.json\n", study::tally(rows), (folder / "stability.md").string());
    const auto failed = [](const StabilityRow& row) { return row.outcome.verdict == Verdict::Fail; };
    return std::ranges::any_of(rows, failed) ? 1 : 0;
}

}  // namespace

void addStabilityStudy(CLI::App& study, Action& action) {
    const auto folder = std::make_shared<std::string>();
    CLI::App* command = study.add_subcommand("stability", "Runs stiff and extreme cases and judges each");
    command->add_option("--out", *folder, "folder for stability.md and stability.json")->required();
    command->callback([folder, &action] { action = [folder] { return studyStability(*folder); }; });
}

}  // namespace insonify::deployer
