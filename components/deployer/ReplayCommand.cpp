// insonify replay LOG DEPLOYMENT [--rerender [--score]]
#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "components/deployer/Commands.hpp"
#include "components/deployer/ReplaySpec.hpp"
#include "components/deployer/RunOptions.hpp"
#include "components/deployer/ScoreReport.hpp"
#include "components/deployer/StopSignal.hpp"

namespace insonify::deployer {
namespace {

constexpr const char* rerendered_file = "rerendered.0.log";

struct Options : RunOptions {
    ReplayOptions replay;
    bool score = false, step = false;
    size_t worst = 10;
};

/** The seed that a log was recorded with; 0 when that is not known. */
uint64_t recordedSeed(const pocolog::Reader& log) {
    for (const pocolog::Stream& stream : log.streams())
        if (const auto seed = stream.metadata.find("insonify_seed"); seed != stream.metadata.end())
            return std::strtoull(seed->second.c_str(), nullptr, 10);
    return 0;
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
    if (std::ranges::any_of(scores, [](const StreamScore& score) { return !score.pings.empty(); })) return 0;
    fmt::print(stderr, "insonify: no ping of {} could be compared with one that was rendered again\n",
               log.path().string());
    return 1;
}

/** Waits for a line on stdin; at the end of stdin no longer. */
void waitForLine(const std::atomic<bool>& stop) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    for (char read_last = 0; !stop && read_last != '\n';)
        if (poll(&input, 1, 50) != 0 && read(STDIN_FILENO, &read_last, 1) != 1) return;
}

int replay(Options options) {
    pocolog::Reader log(options.replay.log);
    framework::DeploymentSpec spec = loadSpec(options);
    const std::vector<std::string> streams = options.score ? pingStreams(log, spec) : std::vector<std::string>{};
    if (options.score && streams.empty())
        throw types::ConfigError(log.path(), "", "holds no pings of a task of " + spec.file + "; nothing to score");
    spec = replaying(std::move(spec), log, options.replay);
    if (options.score) addLogger(spec, streams, rerendered_file);
    if (options.replay.rerender && options.seed == 0) options.seed = recordedSeed(log);
    if (options.step)
        options.progress = [&stop = stopOnSignals()](const framework::Progress& progress) {
            fmt::print(stderr, "{:.6f} s\n", progress.elapsed_s);
            waitForLine(stop);
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
    command->add_option("LOG", options->replay.log, "a pocolog file")->required();
    command->add_option("DEPLOYMENT", options->deployment, "a YAML file")->required();
    auto* pace = command->add_option("--pace", options->limits.pace,
                                     "log seconds per second of the wall clock (default: as fast as it goes)");
    pace->type_name("P")->check(refuseUnlessPositive);
    command->add_option("--from", options->replay.from, "start S seconds after the log's first stamp")
        ->type_name("S")
        ->check(CLI::NonNegativeNumber);
    auto* loop = command->add_flag("--loop", options->replay.loop, "on and on, until --pings, --duration or SIGINT");
    command->add_flag("--step", options->step, "one instant of the log for each line on stdin")->excludes(pace);
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
