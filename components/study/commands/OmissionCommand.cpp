// insonify study omission DEPLOYMENT
#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>
#include <stdexcept>

#include "components/console/Console.hpp"
#include "components/console/Json.hpp"
#include "components/console/OutputFolder.hpp"
#include "components/console/ProgressLine.hpp"
#include "components/deployer/Pipeline.hpp"
#include "components/study/OmissionStudy.hpp"
#include "components/study/commands/StudyCommand.hpp"

namespace insonify::study {
namespace {

using console::Json;

struct Options {
    std::string deployment, out;
    uint64_t ping = 1;
    int pings = 30;
    bool quiet = false;
};

const char* verdict(const OmissionRow& row) {
    if (row.kept) return "kept";
    if (!row.measured) return "not measured";
    return row.holds() ? "pass" : "FAIL";
}

Json toJson(const OmissionRow& row) {
    Json json{{"name", row.name}, {"reason", row.reason}, {"verdict", verdict(row)}};
    if (row.measured)
        json.update({{"change", row.measured->change},
                     {"rel_l2_tvg", row.measured->rel_l2_tvg},
                     {"without_ms", row.measured->without_ms},
                     {"with_ms", row.measured->with_ms}});
    if (row.bound) json.update({{"bound", *row.bound}, {"bound_of", row.bound_of}});
    return json;
}

std::string line(const OmissionRow& row) {
    if (!row.measured) return fmt::format("| {} | {} | | | | | | {} |\n", row.name, row.reason, verdict(row));
    const Ablation& a = *row.measured;
    return fmt::format("| {} | {} | {:.2g} | {:.2g} | {} | {:.3f} | {:.3f} | {} |\n", row.name, row.reason, a.change,
                       a.rel_l2_tvg, row.bound ? fmt::format("{:.2g} of {}", *row.bound, row.bound_of) : "",
                       a.without_ms, a.with_ms, verdict(row));
}

std::string sheet(const std::string& deployment, const std::vector<OmissionRow>& rows) {
    std::string text = fmt::format(
        "# Omissions of {}\n\nEach line renders one ping without and with an effect. Change: max difference of "
        "a bin over the loudest bin; rel_l2_tvg: relative L2 of all bins after a gain of 50 log10(r); times are "
        "medians of a ping. `kept` is configured, and shown for its influence and cost; `not measured` is not built, "
        "or "
        "follows from its reason alone.\n\n"
        "| what | reason | change | rel_l2_tvg | bound | without [ms] | with [ms] | verdict |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
        deployment);
    for (const OmissionRow& row : rows) text += line(row);
    return text;
}

int runStudy(const Options& options) {
    const deployer::SonarAt sonar = deployer::sonarAt(options.deployment, options.ping);
    console::OutputFolder folder(options.out, "study_omission");
    console::StudyProgress progress(!options.quiet);
    const std::vector<OmissionRow> rows =
        studyOmissions(sonar.config, sonar.snapshot, options.pings, std::ref(progress));
    progress.end();
    folder.keep();
    const std::string text = sheet(options.deployment, rows);
    std::ofstream file(folder.path() / "omission.md");
    if (!(file << text).flush())
        throw std::runtime_error((folder.path() / "omission.md").string() + " cannot be written");
    Json json = Json::array();
    for (const OmissionRow& row : rows) json.push_back(toJson(row));
    console::write(json, (folder.path() / "omission.json").string());
    console::printResult("{}", text);
    return std::ranges::all_of(rows, &OmissionRow::holds) ? 0 : 1;
}

}  // namespace

void addOmissionStudy(CLI::App& study, console::Action& action) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = study.add_subcommand("omission", "Bins and time with and without each omission of the plan");
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file whose sonar and scene are studied")->required();
    command->add_option("--out", options->out, "folder of omission.md and omission.json");
    command->add_option("--ping", options->ping, "which ping of the deployment")->check(CLI::PositiveNumber);
    command->add_option("--pings", options->pings, "pings timed for each")->check(CLI::Range(1, 1000));
    command->add_flag("--quiet", options->quiet, "no progress");
    command->callback([options, &action] { action = [options] { return runStudy(*options); }; });
}

}  // namespace insonify::study
