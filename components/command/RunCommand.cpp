#include "components/command/RunCommand.hpp"

// insonify run DEPLOYMENT

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>

#include "components/command/CommandLine.hpp"
#include "components/command/Summary.hpp"
#include "components/console/Console.hpp"
#include "components/console/OutputFolder.hpp"
#include "components/console/ProgressLine.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/RunFiles.hpp"
#include "components/deployer/StopSignal.hpp"
#include "components/deployer/Supervision.hpp"
#include "components/framework/Offers.hpp"
#include "components/framework/config/YamlText.hpp"
#include "components/pose/TrajectoryTask.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

void addSet(CLI::App& command, std::vector<std::string>& set) {
    command.add_option("--set", set, "task.property.path=value: a property other than in the file; may be repeated")
        ->allow_extra_args(false);
}

}  // namespace

void RunOptions::addDeploymentTo(CLI::App& command) {
    command.add_option("DEPLOYMENT", deployment, "a YAML file, or a folder with one deployment")->required();
    addSet(command, set);
}

void RunOptions::addTo(CLI::App& command) {
    auto* pings = command.add_option("--pings", limits.samples, "end when every sonar has sent N pings")
                      ->type_name("N")
                      ->check(console::refuseUnlessPositive);
    command.add_option("--duration", limits.duration_s, "end after S seconds on the deployment's clock")
        ->type_name("S")
        ->check(console::refuseUnlessPositive)
        ->excludes(pings);
    command.add_option("--out", out, "folder for the files (default: out/<deployment>-<UTC time>)")->type_name("DIR");
    addSet(command, set);
    command.add_option("--seed", seed, "seeds every task with a hash of N and its name (0: as the file says)")
        ->type_name("N")
        ->check(console::refuseUnlessWhole);
    command
        .add_option("--ros-args", ros,
                    "arguments of ROS 2, up to -- or the end: -r FROM:=TO, -r __ns:=/auv2, -r __node:=x, "
                    "-p TASK.PROPERTY:=VALUE, --params-file FILE")
        ->type_name("...")
        ->allow_extra_args(false);
    command.add_option("--summary", summary, "writes the summary as JSON")->type_name("FILE");
    auto* silent = command.add_flag("--quiet", quiet, "no progress, no notices, no summary");
    command.add_flag("--verbose", verbose, "also the times of all tasks and stages, and what is omitted")
        ->excludes(silent);
    command.add_flag("--stats", stats, "also what the stages of each sonar's pings count: rays, cells, paths, ...")
        ->excludes(silent);
}

framework::DeploymentSpec loadSpec(const RunOptions& options) {
    framework::DeploymentSpec spec = framework::DeploymentSpec::load(deploymentIn(options.deployment));
    for (const std::string& assignment : options.recorded) {
        const size_t equals = assignment.find('=');
        const std::string property = assignment.substr(0, equals);
        const auto [task, name] = framework::splitPort(property);
        spec.set(property, framework::parseValue(assignment.substr(equals + 1)),
                 {recorded_origin, fmt::format("tasks.{}.properties.{}", task, name)});
    }
    for (const std::string& assignment : options.set) spec.set(assignment);
    applyRosArguments(options.ros, spec);
    return spec;
}

namespace {

using console::OutputFolder;

/** The trajectory that ends last, and when, where no limit ends a run in lockstep. */
struct LastTrajectory {
    std::string task;
    double end = 0;  ///< Infinite for a loop; 0: unknown [s].
};

LastTrajectory lastTrajectory(const framework::Deployment& deployment) {
    LastTrajectory last;
    for (const auto& task : deployment.tasks())
        if (const auto* trajectory = dynamic_cast<const pose::TrajectoryTask*>(task.get());
            trajectory && trajectory->duration() > last.end)
            last = {task->name(), trajectory->duration()};
    return deployment.spec().lockstep ? last : LastTrajectory{};
}

/** Refuses a run in lockstep that no limit ends and that would last longer than anybody means; reports one that never
 *  ends. */
void refuseUnmeantLength(const framework::Deployment& deployment, const RunOptions& options) {
    constexpr double week = 7 * 86'400;  // [s]
    const auto& limits = options.limits;
    const LastTrajectory last = lastTrajectory(deployment);
    if (last.end <= week || limits.samples > 0 || limits.duration_s > 0 || limits.shard) return;
    if (!std::isfinite(last.end)) {
        if (!options.quiet)
            console::printDiagnostic(
                "notice: {}: loops, so the run ends at SIGINT; --duration S or --pings N ends it earlier\n", last.task);
        return;
    }
    throw types::ConfigError(
        deployment.spec().file, "tasks." + last.task,
        fmt::format("its trajectory ends {:.12g} s ({:.3g} days) after the start of the run, which no limit ends; more "
                    "than {:g} days need --duration S or --pings N. If its times are of another unit or clock, set "
                    "time_unit, start or start_s",
                    last.end, last.end / 86'400, week / 86'400));
}

/** Refuses a number of pings where no task makes any: the run would never end. */
void refuseUncountable(const framework::Deployment& deployment, const RunOptions& options) {
    if (options.limits.samples == 0) return;
    const auto isCounted = [](const framework::PortBase* port) { return port->counted(); };
    for (const auto& task : deployment.tasks())
        if (std::ranges::any_of(task->outputs(), isCounted)) return;
    throw types::ConfigError(deployment.spec().file, "--pings",
                             fmt::format("is {}, and no task of the deployment makes pings; give --duration S instead",
                                         options.limits.samples));
}

/** Shows a run's progress on a terminal: done, total and remaining time. */
class RunProgress {
public:
    RunProgress(const framework::Deployment& deployment, const RunOptions& options)
        : line_(!options.quiet), pings_(options.limits.samples), seconds_(options.limits.duration_s) {
        const double end = lastTrajectory(deployment).end;
        if (pings_ == 0 && seconds_ == 0 && std::isfinite(end)) seconds_ = end;
    }
    void operator()(const framework::Progress& progress) {
        const uint64_t pings = pings_ > 0 ? progress.samples : progress.most;
        const double made = static_cast<double>(pings);
        const double share = pings_ > 0     ? made / static_cast<double>(pings_)
                             : seconds_ > 0 ? progress.elapsed_s / seconds_
                                            : 0;
        line_.show(progress.wall_s,
                   fmt::format("{}{} pings, {:.1f} per second, {:.1f}{} s simulated{}", pings,
                               pings_ > 0 ? fmt::format(" of {}", pings_) : "", made / progress.wall_s,
                               progress.elapsed_s, seconds_ > 0 ? fmt::format(" of {:.1f}", seconds_) : "",
                               console::timeLeft(share, progress.wall_s)));
    }

private:
    console::ProgressLine line_;
    uint64_t pings_;
    double seconds_;
};

types::Notices without(types::Notices notices, const types::Notices& reported) {
    std::erase_if(notices, [&](const types::Notice& notice) { return std::ranges::count(reported, notice) > 0; });
    return notices;
}

void printNotices(const framework::TaskContext& task, const types::Notices& notices) {
    for (const types::Notice& notice : notices) console::printDiagnostic("{}\n", labelled(notice, task.name() + ": "));
}

/** Checks without making a file. */
void refuseUnwritable(const RunOptions& options, const std::string& deployment) {
    namespace fs = std::filesystem;
    for (const auto& [option, file] : {std::pair("--summary", &options.summary), {"--health", &options.health}})
        if (std::error_code none; fs::equivalent(*file, deployment, none))
            throw types::ConfigError(*file, option, "is the deployment itself; give another file");
    const fs::path summary_file = options.summary;
    const fs::path folder = summary_file.has_parent_path() ? summary_file.parent_path() : ".";
    const fs::path evaluated = fs::exists(summary_file) ? summary_file : folder;
    if (!summary_file.empty() && (fs::is_directory(summary_file) || access(evaluated.c_str(), W_OK) != 0))
        throw types::ConfigError(summary_file, "--summary", "cannot be written to");
}

types::Notices getNotices(const framework::TaskContext& task) {
    types::Notices all = task.notices();
    if (const types::Plan* plan = framework::makePlan(task))
        for (const types::Notice& notice : without(plan->notices, all)) all.push_back(notice);
    return all;
}

/** Returns those of each task, in file order. */
std::vector<types::Notices> getNotices(const framework::Deployment& deployment) {
    std::vector<types::Notices> all;
    for (const auto& task : deployment.tasks()) all.push_back(getNotices(*task));
    return all;
}

/** Prints new notices since `reported`. */
void printNew(const framework::Deployment& deployment, const std::vector<types::Notices>& reported) {
    for (size_t i = 0; i < reported.size(); ++i) {
        const framework::TaskContext& task = *deployment.tasks()[i];
        printNotices(task, without(getNotices(task), reported[i]));
    }
}

/** Prints what the run has made. */
void report(const framework::Deployment& deployment, const RunOptions& options, const Summary& summary,
            const std::filesystem::path& folder, const FolderListing& before) {
    if (options.verbose) console::addResult(summary.details());
    if (options.stats) console::addResult(summary.stats());
    console::addResult(summary.text());
    if (const uint64_t dropped = console::droppedDiagnostics(); dropped > 0)
        console::printResult("{} lines of notices and warnings could not be printed\n", dropped);
    if (!options.shard) console::addResult(filesText(folder, before, deployment));
}

/** Splits at commas outside of brackets. */
std::vector<std::string> argumentsIn(const std::string& text) {
    std::vector<std::string> arguments(1);
    int depth = 0;
    for (const char c : text) {
        depth += static_cast<int>(c == '[' || c == '{') - static_cast<int>(c == ']' || c == '}');
        if (c == ',' && depth == 0)
            arguments.emplace_back();
        else
            arguments.back() += c;
    }
    return arguments;
}

void callAll(framework::Deployment& deployment, const RunOptions& options) {
    for (const std::string& call : options.calls) {
        const size_t equals = call.find('=');
        const auto arguments =
            equals == std::string::npos ? std::vector<std::string>{} : argumentsIn(call.substr(equals + 1));
        std::string result;
        try {
            result = deployment.call(call.substr(0, equals), arguments);
        } catch (const types::ConfigError& error) {
            throw types::ConfigError("", "--call", "is " + call + ": " + error.diagnostics().front().text());
        } catch (const std::exception& failure) {
            throw std::runtime_error("--call " + call + ": " + types::getReason(failure));
        }
        if (!options.quiet && !result.empty()) console::printResult("{}: {}\n", call, result);
    }
}

framework::RunResult runAll(framework::Deployment& deployment, const RunOptions& options,
                            const std::atomic<bool>& stop) {
    if (!options.quiet) {
        for (const auto& task : deployment.tasks()) printNotices(*task, task->notices());
        deployment.onWarning([](const std::string& text) { console::printDiagnostic("warning: {}\n", text); });
    }
    if (options.progress)
        return deployment.run(options.limits, stop,
                              [&](const framework::Progress& progress) { options.progress(deployment, progress); });
    RunProgress progress(deployment, options);
    return deployment.run(options.limits, stop, std::ref(progress));
}

}  // namespace

std::string labelled(const types::Notice& notice, const std::string& name) {
    return (notice.kind == types::Notice::Kind::Warning ? "warning: " : "notice: ") + name + notice.text;
}

int runDeployment(framework::DeploymentSpec spec, const RunOptions& options, std::filesystem::path* written_to) {
    framework::Registry registry = coreTasks();
    framework::Deployment deployment(std::move(spec), registry, options.out, options.seed.value_or(0));
    if (options.shard) refuseIndivisible(deployment);
    OutputFolder folder(options.out, options.deployment);
    deployment.environment().output_folder = folder.path();
    if (written_to) *written_to = folder.path();
    refuseUnwritable(options, deployment.spec().file);

    const std::atomic<bool>& stop = stopOnSignals();
    Supervision supervision(options.health);
    const FolderListing before = options.quiet || options.shard ? FolderListing() : listFolder(folder.path());
    console::startPrinting();
    deployment.configure();
    refuseUnmeantLength(deployment, options);
    refuseUncountable(deployment, options);
    folder.keep();
    if (folder.hadFiles() && !options.quiet && !options.shard)
        console::printDiagnostic(
            "notice: {} has files already; those with the names of this run's files are replaced\n",
            folder.path().string());
    callAll(deployment, options);

    const std::vector<types::Notices> reported = getNotices(deployment);
    supervision.watch(deployment, stop);
    framework::RunResult result = runAll(deployment, options, stop);
    const Summary summary(deployment, result);
    if (!options.quiet) printNew(deployment, reported);
    for (std::string& failure : deployment.cleanup()) result.failures.push_back(std::move(failure));
    // All files are closed: from here on, the console may keep the process waiting.
    if (!options.summary.empty()) console::write(summary.json(), options.summary);
    if (!options.quiet) report(deployment, options, summary, folder.path(), before);
    for (const std::string& failure : result.failures) console::printDiagnostic("insonify: {}\n", failure);
    return result.failed() ? 1 : 0;
}

void addRunCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<RunOptions>();
    CLI::App* command = app.add_subcommand("run", "Runs a deployment, or a shard of it");
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file, or a folder with one deployment")->required();
    options->addTo(*command);
    command
        ->add_option("--health", options->health,
                     "the state of the run in JSON: in a file that is replaced each second, or by HTTP on a port, 200 "
                     "while all tasks run and none hangs, else 503")
        ->type_name("FILE|[ADDRESS:]PORT");
    CLI::Option* const calls =
        command
            ->add_option(
                "--call", options->calls,
                "task.operation[=argument,...]: calls it once all is configured; may be repeated, called in order")
            ->allow_extra_args(false);
    command
        ->add_option_function<std::string>(
            "--shard", [options](const std::string& text) { options->shard = console::Shard::read(text); },
            "i/N: makes the i-th of N parts of the run's pings, i from 0; needs --out, which all parts share")
        ->type_name("i/N")
        ->check(console::Shard::refuse)
        ->excludes(calls);
    command->callback([options, &action] {
        action = [options] {
            options->deployment = deploymentIn(options->deployment);
            return options->shard ? runShard(*options) : runDeployment(loadSpec(*options), *options);
        };
    });
}

}  // namespace insonify::command
