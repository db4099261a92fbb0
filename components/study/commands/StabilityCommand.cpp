// insonify study stability --out DIR [--only TEXT]
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "components/console/Console.hpp"
#include "components/console/ProgressLine.hpp"
#include "components/study/commands/StudyCommand.hpp"
#include "components/study/stability/StabilityStudy.hpp"
#include "types/text/ConfigError.hpp"

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
    console::printResult("{:>3}  {:<7}  {:>8}  {}\n", row.number, getName(outcome.verdict),
                         isEvaluated(outcome) ? fmt::format("{:.1e}", outcome.deviation) : "", row.name);
    if (outcome.verdict == Verdict::Fail)
        console::printResult("     expected: {}\n     got: {}\n", row.expected, outcome.got);
    if (outcome.verdict == Verdict::NotRun) console::printResult("     {}\n", outcome.got);
    console::flushResults();
}

/** Returns the cases whose names contain `text`; all if it is empty. */
std::vector<StabilityCase> casesWith(const std::string& text) {
    std::vector<StabilityCase> cases = stabilityCases();
    std::erase_if(cases, [&](const StabilityCase& c) { return c.name.find(text) == c.name.npos; });
    if (cases.empty()) throw types::ConfigError("", "--only", fmt::format("no case has \"{}\" in its name", text));
    return cases;
}

int runStudy(const std::filesystem::path& folder, const std::string& only) {
    std::vector<StabilityCase> cases = casesWith(only);
    makeFolder(folder);
    console::printResult("case  verdict    deviation\n");
    console::StudyProgress progress(true, cases.size());
    const std::vector<StabilityRow> rows = studyStability(std::move(cases), [&](const StabilityRow& row) {
        progress.end();
        printRow(row);
        progress.advance();
        progress("cases");
    });
    progress.end();
    writeStability(rows, folder);
    console::printResult("{}; {} and stability.json\n", tally(rows), (folder / "stability.md").string());
    const auto failed = [](const StabilityRow& row) { return row.outcome.verdict == Verdict::Fail; };
    return std::ranges::any_of(rows, failed) ? 1 : 0;
}

}  // namespace

void addStabilityStudy(CLI::App& study, console::Action& action) {
    const auto folder = std::make_shared<std::string>(), only = std::make_shared<std::string>();
    CLI::App* command = study.add_subcommand("stability", "Runs stiff and extreme cases and evaluates each");
    command->add_option("--out", *folder, "folder for stability.md and stability.json")->required();
    command->add_option("--only", *only, "only cases whose names contain this text");
    command->callback([=, &action] { action = [=] { return runStudy(*folder, *only); }; });
}

}  // namespace insonify::study
