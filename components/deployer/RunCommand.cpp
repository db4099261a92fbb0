// insonify run DEPLOYMENT
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "components/deployer/Commands.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/OutputFolder.hpp"
#include "components/deployer/RunOptions.hpp"
#include "components/deployer/StopSignal.hpp"
#include "components/deployer/Summary.hpp"
#include "components/deployer/Tasks.hpp"
#include "types/ConfigError.hpp"

namespace insonify::deployer {
namespace {

/** One line on a terminal, ten times a second, wiped at the end; nothing elsewhere. */
class ProgressLine {
public:
    explicit ProgressLine(bool wanted) : shown_(wanted && isatty(STDERR_FILENO)) {}
    ~ProgressLine() {
        if (shown_) fmt::print(stderr, "\r\033[K");
    }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void operator()(const framework::Progress& progress) {
        if (!shown_ || progress.wall_s < next_s_) return;
        next_s_ = progress.wall_s + 0.1;
        fmt::print(stderr, "\r\033[K{} pings, {:.1f} per second, {:.1f} s simulated", progress.pings,
                   static_cast<double>(progress.pings) / progress.wall_s, progress.elapsed_s);
        std::fflush(stderr);
    }

private:
    bool shown_;
    double next_s_ = 0.1;
};

std::vector<std::string> without(std::vector<std::string> notices, const std::vector<std::string>& told) {
    std::erase_if(notices, [&](const std::string& notice) { return std::ranges::count(told, notice) > 0; });
    return notices;
}

void printNotices(const framework::TaskContext& task, const std::vector<std::string>& notices) {
    for (const std::string& notice : notices) fmt::print(stderr, "notice: {}: {}\n", task.name(), notice);
}

/** Looks, but makes no file yet. */
void refuseUnwritable(const std::filesystem::path& summary_file) {
    namespace fs = std::filesystem;
    const fs::path folder = summary_file.has_parent_path() ? summary_file.parent_path() : ".";
    const fs::path judged = fs::exists(summary_file) ? summary_file : folder;
    if (!summary_file.empty() && (fs::is_directory(summary_file) || access(judged.c_str(), W_OK) != 0))
        throw types::ConfigError(summary_file, "--summary", "cannot be written to");
}

std::vector<std::string> noticesOf(const framework::TaskContext& task) {
    std::vector<std::string> all = task.notices();
    if (const types::Plan* plan = task.plan())
        for (const std::string& notice : without(plan->notices, all)) all.push_back(notice);
    return all;
}

/** Of each task, in file order. */
using Notices = std::vector<std::vector<std::string>>;

Notices noticesOf(const framework::Deployment& deployment) {
    Notices all;
    for (const auto& task : deployment.tasks()) all.push_back(noticesOf(*task));
    return all;
}

/** Notices that have come up while it ran, and the summary. */
void tell(const framework::Deployment& deployment, const Notices& told, const Summary& summary,
          const OutputFolder& folder) {
    for (size_t i = 0; i < told.size(); ++i) {
        const framework::TaskContext& task = *deployment.tasks()[i];
        printNotices(task, without(noticesOf(task), told[i]));
    }
    fmt::print("{}files in {}\n", summary.text(), folder.path().string());
}

/** Split at its commas, those within brackets left alone. */
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
        const std::string result =
            deployment.call(call.substr(0, equals), equals == std::string::npos ? std::vector<std::string>{}
                                                                                : argumentsIn(call.substr(equals + 1)));
        if (!options.quiet && !result.empty()) fmt::print("{}: {}\n", call, result);
    }
}

framework::RunResult runAll(framework::Deployment& deployment, const RunOptions& options,
                            const std::atomic<bool>& stop) {
    if (!options.quiet) {
        for (const auto& task : deployment.tasks()) printNotices(*task, task->notices());
        deployment.onWarning([](const std::string& text) { fmt::print(stderr, "warning: {}\n", text); });
    }
    if (options.progress)
        return deployment.run(options.limits, stop,
                              [&](const framework::Progress& progress) { options.progress(deployment, progress); });
    ProgressLine progress(!options.quiet);
    return deployment.run(options.limits, stop, std::ref(progress));
}

}  // namespace

int runDeployment(framework::DeploymentSpec spec, const RunOptions& options, std::filesystem::path* written_to) {
    framework::Registry registry = builtInTasks();
    framework::Deployment deployment(std::move(spec), registry, options.out, options.seed.value_or(0));
    OutputFolder folder(options.out, options.deployment);
    deployment.environment().output_folder = folder.path();
    if (written_to) *written_to = folder.path();
    refuseUnwritable(options.summary);

    const std::atomic<bool>& stop = stopOnSignals();
    deployment.configure();
    folder.keep();
    callAll(deployment, options);

    const Notices told = noticesOf(deployment);
    framework::RunResult result = runAll(deployment, options, stop);
    const Summary summary(deployment, result);
    if (!options.quiet) tell(deployment, told, summary, folder);
    if (!options.summary.empty()) write(summary.json(), options.summary);
    for (std::string& failure : deployment.cleanup()) result.failures.push_back(std::move(failure));
    for (const std::string& failure : result.failures) fmt::print(stderr, "insonify: {}\n", failure);
    return result.failed() ? 1 : 0;
}

void addRunCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<RunOptions>();
    CLI::App* command = app.add_subcommand("run", "Runs a deployment");
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file, or a folder with one deployment")->required();
    options->addTo(*command);
    command
        ->add_option("--call", options->calls,
                     "task.operation[=argument,...]: calls it once all is configured; may be repeated, called in order")
        ->allow_extra_args(false);
    command->callback([options, &action] {
        action = [options] {
            options->deployment = deploymentIn(options->deployment);
            return runDeployment(loadSpec(*options), *options);
        };
    });
}

}  // namespace insonify::deployer
