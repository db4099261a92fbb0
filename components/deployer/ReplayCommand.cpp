// insonify replay LOG DEPLOYMENT [--rerender [--score]]
#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "components/deployer/Commands.hpp"
#include "components/deployer/RecordedSettings.hpp"
#include "components/deployer/ReplaySpec.hpp"
#include "components/deployer/RunOptions.hpp"
#include "components/deployer/ScoreReport.hpp"
#include "components/deployer/StopSignal.hpp"
#include "components/mcap/LogSource.hpp"
#include "types/Reason.hpp"

namespace insonify::deployer {
namespace {

constexpr const char* rerendered_file = "rerendered.0.log";

struct Options : RunOptions {
    ReplayOptions replay;
    bool score = false, step = false;
    size_t worst = 10;
};

/** The log's own settings, below those of the user. */
void takeSettings(const pocolog::Reader& log, Options& options) {
    const std::vector<std::string> recorded = recordedSettings(log, loadSpec(options), options.set, options.seed);
    if (!options.quiet)
        for (const std::string& setting : recorded) fmt::print(stderr, "notice: as in the log: {}\n", setting);
    options.set.insert(options.set.begin(), recorded.begin(), recorded.end());
    if (!options.seed) options.seed = recordedSeed(log);
}

/** Scores the log against what was rendered again, and tells. Gives the exit code. */
int tellScore(pocolog::Reader& log, const std::vector<std::string>& streams, size_t worst,
              const std::filesystem::path& folder) {
    pocolog::Reader rendered(folder / rerendered_file);
    std::vector<StreamScore> scores;
    for (const std::string& stream : streams) scores.push_back(score(log, rendered, stream));
    write(scoreJson(scores), folder / "score.json");
    writeScorePictures(log, rendered, scores, worst, folder);
    fmt::print("{}", scoreTable(scores, worst));
    for (const StreamScore& score : scores)
        if (const std::string rest = leftOut(score); !rest.empty())
            fmt::print(stderr, "warning: {}: not all pings were compared: {}\n", score.stream, rest);
    if (std::ranges::any_of(scores, [](const StreamScore& score) { return !score.pings.empty(); })) return 0;
    fmt::print(stderr, "insonify: no ping of {} could be compared with one that was rendered again\n",
               log.path().string());
    return 1;
}

/** Waits for a line on stdin; at the end of stdin no longer. */
std::string nextLine(const std::atomic<bool>& stop) {
    std::string line;
    pollfd input{STDIN_FILENO, POLLIN, 0};
    for (char read_last = 0; !stop && read_last != '\n';) {
        if (poll(&input, 1, 50) == 0) continue;
        if (read(STDIN_FILENO, &read_last, 1) != 1) break;
        if (read_last != '\n') line += read_last;
    }
    return line;
}

/** Waits for a line that lets the next instant come, `seek S` that from another place; one that is refused does not. */
void waitForStep(framework::Deployment& deployment, const std::atomic<bool>& stop) {
    const std::string seek = "seek ";
    for (std::string line = nextLine(stop); line.starts_with(seek); line = nextLine(stop)) try {
            deployment.call(deployment.tasks().front()->name() + ".seek", {line.substr(seek.size())});
            return;
        } catch (const std::exception& error) {
            fmt::print(stderr, "insonify: {}\n", types::reasonOf(error));
        }
}

int replay(Options options) {
    const auto opened = mcap::openLog(options.replay.log);
    pocolog::Reader& log = *opened;
    if (options.replay.rerender) takeSettings(log, options);
    framework::DeploymentSpec spec = loadSpec(options);
    const std::vector<std::string> streams = options.score ? pingStreams(log, spec) : std::vector<std::string>{};
    if (options.score && streams.empty())
        throw types::ConfigError(log.path(), "", "holds no pings of a task of " + spec.file + "; nothing to score");
    spec = replaying(std::move(spec), log, options.replay);
    if (options.score) addLogger(spec, streams, rerendered_file);
    if (options.step)
        options.progress = [&stop = stopOnSignals()](framework::Deployment& deployment,
                                                     const framework::Progress& progress) {
            fmt::print(stderr, "{:.6f} s\n", progress.elapsed_s);
            waitForStep(deployment, stop);
        };
    std::filesystem::path folder;
    const int code = runDeployment(std::move(spec), options, &folder);
    return code == 0 && options.score ? tellScore(log, streams, options.worst, folder) : code;
}

}  // namespace

void addReplayCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("replay", "Runs a deployment on a log's time, with its streams in the place of tasks");
    command->add_option("LOG", options->replay.log, "a pocolog or MCAP file")->required();
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file")->required();
    auto* pace = command->add_option("--pace", options->limits.pace,
                                     "log seconds per second of the wall clock (default: as fast as it goes)");
    pace->type_name("P")->check(refuseUnlessPositive);
    command->add_option("--from", options->replay.from, "start S seconds after the log's first stamp")
        ->type_name("S")
        ->check(CLI::NonNegativeNumber);
    auto* loop = command->add_flag("--loop", options->replay.loop, "on and on, until --pings, --duration or SIGINT");
    command
        ->add_flag("--step", options->step,
                   "one instant of the log for each line on stdin; a line `seek S` goes to S seconds of the log")
        ->excludes(pace);
    auto* rerender = command->add_flag("--rerender", options->replay.rerender,
                                       "the log's poses drive the sonars, which render anew");
    auto* score = command->add_flag("--score", options->score, "compares what is rendered with the log's pings");
    score->needs(rerender)->excludes(loop);
    command->add_option("--worst", options->worst, "pings in the table and in pictures (default: 10)")
        ->type_name("N")
        ->needs(score);
    options->addTo(*command);
    command->callback([options, &action] { action = [options] { return replay(*options); }; });
}

}  // namespace insonify::deployer
