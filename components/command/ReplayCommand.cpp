// insonify replay LOG DEPLOYMENT [--rerender [--score]]
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>

#include "components/command/CommandLine.hpp"
#include "components/command/RunCommand.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/StopSignal.hpp"
#include "components/deployer/log/RecordedSettings.hpp"
#include "components/deployer/log/ReplaySpec.hpp"
#include "components/deployer/log/Score.hpp"
#include "components/log/PoseSources.hpp"
#include "components/log/Reader.hpp"
#include "components/recordings/RecordingReader.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::command {

using namespace deployer;

namespace {

constexpr const char* rerendered_file = "rerendered.0.log";

struct ReplayAsked : RunOptions {
    ReplayOptions replay;
    std::string from, orientation;
    std::vector<std::string> poses;  ///< "SOURCE" or "SOURCE=TASK.PORT"
    std::vector<double> datum;       ///< Latitude and longitude [deg], height [m].
    bool score = false, step = false;
    size_t worst = 10;
};

void notice(const ReplayAsked& options, const std::string& text) {
    if (!options.quiet && !text.empty()) console::printDiagnostic("notice: {}\n", text);
}

/** Applies the log's own settings of tasks that run, below the user's; returns the changes during the recording. */
std::vector<RecordedProperty> readSettings(const log::Reader& log, ReplayAsked& options) {
    RecordedSettings recorded =
        recordedSettings(log, loadSpec(options), options.set, options.seed, options.replay.from);
    const framework::DeploymentSpec kept = replaying(loadSpec(options), log, options.replay);
    std::erase_if(recorded.assignments,
                  [&](const std::string& setting) { return !kept.task(setting.substr(0, setting.find('.'))); });
    std::erase_if(recorded.changed, [&](const RecordedProperty& property) { return !kept.task(property.task); });
    notice(options, recorded.notice);
    for (const std::string& setting : recorded.assignments)
        notice(options, "as in the log: " + withShortLists(setting));
    for (const RecordedProperty& property : recorded.changed)
        for (const RecordedProperty::Change& change : property.changes)
            notice(options, fmt::format("as in the log, from {} on: {}.{}={}", log::readable(change.from),
                                        property.task, property.name, withShortLists(change.value)));
    options.recorded = std::move(recorded.assignments);
    if (!options.seed) options.seed = recordedSeed(log);
    return std::move(recorded.changed);
}

/** Reports the tasks that do not run because they communicate outside. */
void reportOmitted(const framework::DeploymentSpec& spec, const ReplayAsked& options) {
    if (options.replay.outside) return;
    for (const std::string& task : outsideTasks(spec))
        notice(options, task + " is omitted, because it communicates outside the deployment; --outside runs it");
}

/** Reports the tasks whose settings by `--set` change nothing, because the log replaces their pings. */
void reportReplaced(const framework::DeploymentSpec& spec, const log::Reader& log, const ReplayAsked& options) {
    std::set<std::string> writers;
    for (const std::string& stream : pingStreams(log, spec)) writers.insert(findWriter(spec, stream));
    for (const std::string& task : writers)
        if (std::ranges::any_of(options.set, [&](const std::string& set) { return set.starts_with(task + "."); }))
            notice(options, task + ": the log replaces what it sends; --rerender makes its pings again");
}

/** Scores the log against the new rendering and prints the score. Returns the exit code. */
int printScore(log::Reader& log, const std::vector<std::string>& streams, size_t worst,
               const std::filesystem::path& folder) {
    const auto again = log::openLog(folder / rerendered_file);
    log::Reader& rendered = *again;
    std::vector<StreamScore> scores;
    for (const std::string& stream : streams) scores.push_back(score(log, rendered, stream));
    console::write(scoreJson(scores), (folder / "score.json").string());
    writeScorePictures(log, rendered, scores, worst, folder);
    console::printResult("{}", scoreTable(scores, worst));
    for (const StreamScore& score : scores)
        if (const std::string rest = findOmitted(score); !rest.empty())
            console::printDiagnostic("warning: {}: not all pings were compared: {}\n", score.stream, rest);
    if (std::ranges::any_of(scores, [](const StreamScore& score) { return !score.pings.empty(); })) return 0;
    console::printDiagnostic("insonify: no ping of {} could be compared with one that was rendered again\n",
                             log.path().string());
    return 1;
}

/** Waits for a line on stdin; returns at the end of stdin. */
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

/** Waits for a line that starts the next instant; `seek S` first moves to another time. A refused line is ignored. */
void waitForStep(framework::Deployment& deployment, const std::atomic<bool>& stop) {
    const std::string seek = "seek ";
    for (std::string line = nextLine(stop); line.starts_with(seek); line = nextLine(stop)) try {
            deployment.call(deployment.tasks().front()->name() + ".seek", {line.substr(seek.size())});
            return;
        } catch (const std::exception& error) {
            console::printDiagnostic("insonify: {}\n", types::getReason(error));
        }
}

/** Work between two instants: properties follow the log, and `--step` prints the time in the log and waits. */
void followLog(ReplayAsked& options, std::vector<RecordedProperty> changed, types::Time start) {
    const auto live = std::make_shared<LiveSettings>(std::move(changed));
    std::function<void(framework::Deployment&)> step;
    if (options.step)
        step = [start, &stop = stopOnSignals()](framework::Deployment& deployment) {
            const double place = deployment.status().tasks.front().playback.value().at_s;
            const types::Time at = start + types::Time::fromSeconds(place);
            console::printDiagnostic("{:.6f} s{}\n", place, log::hasDate(at) ? ", " + log::readable(at) : "");
            waitForStep(deployment, stop);
        };
    if (!options.step && live->empty()) return;
    options.progress = [live, step](framework::Deployment& deployment, const framework::Progress&) {
        if (step) step(deployment);
        live->follow(deployment);
    };
}

/** Runs the deployment with the log in the place of tasks; `changed` are properties that follow the log. */
int replayWith(std::vector<RecordedProperty> changed, log::Reader& log, ReplayAsked& options) {
    framework::DeploymentSpec spec = loadSpec(options);
    reportOmitted(spec, options);
    if (!options.replay.rerender) reportReplaced(spec, log, options);
    const std::vector<std::string> streams = options.score ? pingStreams(log, spec) : std::vector<std::string>{};
    if (options.score && streams.empty())
        throw types::ConfigError(log.path(), "", "holds no pings of a task of " + spec.file + "; nothing to score");
    spec = replaying(std::move(spec), log, options.replay);
    if (options.score) addLogger(spec, streams, rerendered_file);
    followLog(options, std::move(changed), log.samples().empty() ? types::Time{} : log.samples().front().time);
    std::filesystem::path folder;
    const int code = runDeployment(std::move(spec), options, &folder);
    return code == 0 && options.score ? printScore(log, streams, options.worst, folder) : code;
}

/** Returns the errors with the log as the origin of its own values. */
types::ConfigError namingLog(types::Diagnostics diagnostics, const std::string& log) {
    for (types::Diagnostic& each : diagnostics)
        if (each.file == recorded_origin)
            each.file = log, each.message += "; the value is the log's, and --set overrides it";
    return types::ConfigError(std::move(diagnostics));
}

/** Refuses a folder of results that would replace the log, its properties and its pictures. */
void refuseFolder(const std::string& log, const std::string& out) {
    std::error_code none;
    const std::filesystem::path path = std::filesystem::absolute(log),
                                folder = std::filesystem::is_directory(path, none) ? path : path.parent_path();
    if (!out.empty() && std::filesystem::equivalent(folder, out, none))
        throw types::ConfigError(out, "--out", "is the folder of the log, whose files would be replaced; give another");
}

/** Returns where a replay starts, after the log's first stamp without the steps of the logger's clock [s]. A date is
 *  that of the first sample with this stamp or a later one, which may be before or after a step. */
double startIn(const log::Reader& log, const std::string& from) {
    const std::vector<log::SampleRef>& samples = log.samples();
    const types::Time first = samples.front().time, given = log::readTime(from, "--from", first);
    if (given < first)
        throw types::ConfigError("", "--from", "is " + from + "; the log begins at " + log::readable(first));
    const bool is_date = log::readTime(from, "--from") == given && first != types::Time{};
    if (!is_date) return (given - first).seconds();
    const log::LoggerClock clock(samples);
    const auto at = std::ranges::find_if(samples, [&](const auto& sample) { return sample.time >= given; });
    if (at == samples.end())  // the task refuses it
        return std::max(given - first, clock.span(samples) + types::Time{1}).seconds();
    return (given - first + clock.evenTime(*at) - at->time).seconds();
}

/** Prints what could be poses in a log, and how it is chosen. */
int listPoses(log::Reader& log) {
    const std::vector<log::FoundPoses> found = log::findPoses(log);
    if (found.empty())
        throw types::ConfigError(log.path(), "",
                                 "has no stream that could be poses; `insonify log info` lists its streams");
    console::printResult("{}: could be the poses of a body:\n{}choose: insonify replay {} DEPLOYMENT --pose {}\n",
                         log.path().string(), log::makeTable(found), console::shellWord(log.path().string()),
                         console::shellWord(found.front().source));
    return 0;
}

/** Returns the source of poses of one `--pose`, for a body of the deployment. */
log::PoseSource poseSource(const ReplayAsked& options, const std::string& given, const std::vector<std::string>& ports,
                           const std::string& deployment) {
    const size_t equals = given.rfind('=');
    log::PoseSource source{given.substr(0, equals), equals == given.npos ? "" : given.substr(equals + 1)};
    if (source.stream.empty() && ports.size() == 1) source.stream = ports.front();
    if (ports.empty() || std::ranges::find(ports, source.stream) == ports.end())
        throw types::ConfigError(deployment, "--pose",
                                 ports.empty()
                                     ? "has no effect: no connection leads to the pose of a scene"
                                     : fmt::format("is {}; the deployment takes poses from {}: give --pose SOURCE={}",
                                                   given, fmt::join(ports, ", "), ports.front()));
    if (!options.datum.empty()) {
        source.datum =
            types::Datum{options.datum[0], options.datum[1], options.datum.size() > 2 ? options.datum[2] : 0};
    }
    source.orientation = options.orientation;
    return source;
}

/** Returns the only source of poses in a log of another program that has no stream of a task of the deployment; empty:
 *  it has one, or no source. Throws ConfigError where there are several. */
std::string onlySource(const framework::DeploymentSpec& spec, log::Reader& log, const ReplayAsked& options) {
    const bool is_own =
        !log.metadatum("insonify_deployment").empty();  // of another deployment, which has pings as well
    if (is_own || hasStream(spec, log)) return {};
    std::vector<log::FoundPoses> found = log::findPoses(log);
    if (found.size() > 1 && options.datum.empty() && !spec.datum)
        std::erase_if(found, [](const log::FoundPoses& each) { return each.has_fixes; });
    if (found.empty()) return {};  // reported as a log of another deployment
    if (found.size() == 1) {
        notice(options, fmt::format("the poses are those of {} {}", found.front().source, found.front().text()));
        return found.front().source;
    }
    std::string choices;
    for (const log::FoundPoses& each : found) choices += "\n  --pose '" + each.source + "' " + each.text();
    throw types::ConfigError(
        log.path(), "--pose",
        "is missing: the log has no stream of a task of " + spec.file + ", and several could be its poses:" + choices);
}

/** Adds the streams of poses that are asked for, or the only one that there is. */
void choosePoses(log::Reader& log, ReplayAsked& options) {
    const framework::DeploymentSpec spec = loadSpec(options);
    std::vector<std::string> given = options.poses;
    if (given.empty())
        if (const std::string only = onlySource(spec, log, options); !only.empty()) given = {only};
    for (const std::string& each : given) {
        const log::PoseSource source = poseSource(options, each, bodyPorts(spec), spec.file);
        log::addPoses(log, source, options.replay.world_frame, spec.datum);  // the task reports the notices
        options.replay.poses.push_back(source);
    }
}

/** Refuses places that are not on the earth. */
void checkDatum(const std::vector<double>& datum) {
    static constexpr struct {
        const char* name;
        double min, max;
    } parts[] = {{"latitude", -90, 90}, {"longitude", -360, 360}, {"height", -12000, 100000}};
    for (size_t i = 0; i < std::min(datum.size(), std::size(parts)); ++i)
        if (!(datum[i] >= parts[i].min && datum[i] <= parts[i].max))
            throw types::ConfigError(
                "", "--datum",
                fmt::format("has the {} {:g}; may be {} to {}", parts[i].name, datum[i], parts[i].min, parts[i].max));
}

int replay(ReplayAsked options) {
    checkDatum(options.datum);
    recordings::refuseRecording(options.replay.log);
    const log::WholeLog opened = log::openWholeLog(options.replay.log, log::AtDamage::Stop, options.replay.world_frame);
    log::Reader& log = *opened.log;
    if (options.deployment.empty()) return listPoses(log);
    refuseFolder(options.replay.log, options.out);
    if (log.samples().empty())
        throw types::ConfigError(options.replay.log, "", "holds no sample; there is nothing to replay");
    choosePoses(log, options);
    if (!options.from.empty()) options.replay.from = startIn(log, options.from);
    std::vector<RecordedProperty> changed;
    if (options.replay.rerender) changed = readSettings(log, options);
    try {
        return replayWith(std::move(changed), log, options);
    } catch (const types::ConfigError& error) {
        throw namingLog(error.diagnostics(), options.replay.log);
    }
}

/** Adds the options that choose poses. */
void addPoseOptions(CLI::App& command, ReplayAsked& options) {
    auto* pose = command.add_option("--pose", options.poses,
                                    "poses of the deployment's body: a topic or stream, or frames of tf as "
                                    "map->base_link; =TASK.PORT behind it chooses one of several bodies");
    pose->type_name("SOURCE")->take_all();
    command.add_option("--datum", options.datum, "origin of the world for fixes [deg, deg, m above the ellipsoid]")
        ->type_name("LATITUDE,LONGITUDE[,HEIGHT]")
        ->delimiter(',')
        ->expected(2, 3);
    command.add_option("--orientation", options.orientation, "topic or stream that turns a body whose poses are fixes")
        ->type_name("SOURCE");
    const auto frame = [&options](const std::string& given) {
        const auto& names = types::EnumNames<types::WorldFrame>::names;
        const auto* const found = std::ranges::find(names, given);
        if (found == std::end(names))
            throw types::ConfigError("", "--world-frame",
                                     fmt::format("is {}; may be {}", given, fmt::join(names, ", ")));
        options.replay.world_frame = static_cast<types::WorldFrame>(found - std::begin(names));
    };
    command.add_option_function<std::string>("--world-frame", frame, "axes of poses of other programs (default: enu)")
        ->type_name("{as_is,enu,ned}");
}

}  // namespace

void addReplayCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<ReplayAsked>();
    CLI::App* command =
        app.add_subcommand("replay", "Runs a deployment on a log's time, with its streams in the place of tasks");
    command->add_option("LOG", options->replay.log, "a pocolog, MCAP or .db3 file, or the folder of a bag")->required();
    command->add_option("DEPLOYMENT", options->deployment,
                        "a YAML file; without it, what could be poses in the log is listed");
    addPoseOptions(*command, *options);
    auto* pace = command->add_option("--pace", options->limits.pace,
                                     "log seconds per second of the wall clock (default: as fast as possible)");
    pace->type_name("P")->check(console::refuseUnlessPositive);
    command->add_option("--from", options->from, "start: seconds after the log's first stamp, or a date in UTC")
        ->type_name("TIME");
    auto* loop =
        command->add_flag("--loop", options->replay.loop, "repeats the log until --pings, --duration or SIGINT");
    command
        ->add_flag("--step", options->step,
                   "one instant of the log for each line on stdin, without waiting from its end on; a line `seek S` "
                   "jumps to S "
                   "seconds of the log")
        ->excludes(pace);
    auto* rerender =
        command->add_flag("--rerender", options->replay.rerender, "renders the pings again, at the log's poses");
    command->add_flag(
        "--outside", options->replay.outside,
        "also runs the tasks that communicate outside (DDS, viewer, devices); by default they are omitted");
    auto* score = command->add_flag("--score", options->score, "compares what is rendered with the log's pings");
    score->needs(rerender)->excludes(loop);
    command->add_option("--worst", options->worst, "pings in the table and in pictures (default: 10)")
        ->type_name("N")
        ->needs(score);
    options->addTo(*command);
    command->callback([options, &action] { action = [options] { return replay(*options); }; });
}

}  // namespace insonify::command
