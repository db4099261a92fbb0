// insonify log info|export|cut|repair|check FILE
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "components/command/CommandLine.hpp"
#include "components/console/Console.hpp"
#include "components/deployer/DeploymentFile.hpp"
#include "components/deployer/Json.hpp"
#include "components/deployer/log/Export.hpp"
#include "components/deployer/log/Import.hpp"
#include "components/deployer/log/LoggedTrack.hpp"
#include "components/deployer/log/RecordedSettings.hpp"
#include "components/log/Copy.hpp"
#include "components/log/Export.hpp"
#include "components/log/Files.hpp"
#include "components/log/PoseSources.hpp"
#include "components/recordings/RecordingReader.hpp"
#include "components/replay/ReplayTask.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::command {

using namespace deployer;

namespace fs = std::filesystem;
namespace {

Json infoJson(const log::Reader& log) {
    Json streams = Json::array();
    for (const log::Stream& stream : log.streams())
        streams.push_back({{"name", stream.name},
                           {"type", stream.type},
                           {"count", stream.count},
                           {"first_s", stream.first.seconds()},
                           {"last_s", stream.last.seconds()},
                           {"rate_hz", stream.rate()},
                           {"set_backs", stream.set_backs}});
    return {{"bytes", log.bytes()}, {"complete", log.complete()}, {"streams", streams}};
}

void printTable(const log::Reader& log) {
    console::printResult("{}: {} bytes, {}\n", log.path().string(), log.bytes(),
                         log.complete() ? "complete" : "cut off");
    console::printResult("  {:24} {:32} {:>8} {:>26} {:>26} {:>9}\n", "stream", "type", "samples", "first", "last",
                         "rate Hz");
    for (const log::Stream& s : log.streams())
        console::printResult("  {:24} {:32} {:>8} {:>26} {:>26} {:>9.2f}\n", s.name, s.type, s.count,
                             log::readable(s.first), log::readable(s.last), s.rate());
    for (const log::Stream& s : log.streams())
        if (s.set_backs > 0)
            console::printResult("  {}: times go back {} times, by {:.6g} s in all: the clock was set back\n", s.name,
                                 s.set_backs, s.set_back.seconds());
}

/** Returns the recordings that can be imported: "FILE.xtf of a side-scan, FILE.aris of an ARIS". */
std::string recordingHelp() {
    std::string help;
    for (const recordings::RecordingFormat& format : recordings::recordingFormats())
        help += format.ending.empty() ? fmt::format("or {}", format.name)
                                      : fmt::format("FILE{} of {}, ", format.ending, format.device);
    return help;
}

/** Opens a log, and prints a notice of further files, and where it cannot be read to its end. */
std::unique_ptr<log::Reader> opened(const std::string& file) {
    recordings::refuseRecording(file);
    log::WholeLog whole = log::openWholeLog(file);
    if (!whole.notice.empty()) console::printDiagnostic("notice: {}\n", whole.notice);
    if (!whole.log->complete()) console::printDiagnostic("notice: {}: {}\n", file, whole.log->diagnostic());
    return std::move(whole.log);
}

/** Returns the files of logs: all of each sequence whose first file is given, unless others of it are given as well. */
std::vector<std::string> getFiles(const std::vector<std::string>& given) {
    std::vector<std::string> all;
    for (const std::string& file : given) {
        const log::WholeLog whole = log::openWholeLog(file, log::AtDamage::Skip);
        const auto isGiven = [&](const fs::path& each) {
            return std::ranges::find(given, each.string()) != given.end();
        };
        if (std::ranges::any_of(whole.files.begin() + 1, whole.files.end(), isGiven)) {
            all.push_back(file);
            continue;
        }
        if (!whole.notice.empty()) console::printDiagnostic("notice: {}\n", whole.notice);
        for (const fs::path& each : whole.files) all.push_back(each.string());
    }
    return all;
}

/** Returns what could be poses in a log of another program; empty for a log of Insonify, whose streams have the names
 * of its deployment. */
std::vector<log::FoundPoses> foreignPoses(log::Reader& log) {
    return log.metadatum("insonify_deployment").empty() ? log::findPoses(log) : std::vector<log::FoundPoses>{};
}

Json posesJson(const std::vector<log::FoundPoses>& found) {
    Json poses = Json::array();
    for (const log::FoundPoses& each : found)
        poses.push_back({{"source", each.source},
                         {"type", each.type},
                         {"parent", each.parent},
                         {"child", each.child},
                         {"count", each.count},
                         {"first_s", each.first.seconds()},
                         {"last_s", each.last.seconds()},
                         {"needs_datum", each.has_fixes}});
    return poses;
}

/** Returns the metadata of each stream: the deployment, the seed and the plan, which the streams of a run share, and
 *  the meaning of the stream's numbers. */
Json metadataJson(const log::Reader& log) {
    Json all = Json::object();
    for (const log::Stream& stream : log.streams())
        all[stream.name] = {{"metadata", stream.metadata}, {"meaning", readMeaning(log, stream)}};
    return all;
}

void printMetadata(const log::Reader& log) {
    std::set<std::pair<std::string, std::string>> reported;  // once for all streams with the same metadata
    for (const log::Stream& stream : log.streams()) {
        console::printResult("\n{}\n{}\n", stream.name, text(readMeaning(log, stream)));
        for (const auto& [key, value] : stream.metadata)
            if (reported.emplace(key, value).second)
                console::printResult("{}:{}{}\n", key, value.find('\n') == value.npos ? " " : "\n", value);
    }
}

struct LogOptions {
    std::string file, deployment, stream, poses, to, samples;
    std::vector<std::string> files, streams;
    std::string from, until;
    std::string for_mcap;  ///< A given option that only an MCAP file takes; empty: none.
    log::McapConfig mcap;
    bool json = false, metadata = false, ground = false, utm = false;
};

Json printInfo(log::Reader& log, bool json, bool metadata) {
    const std::vector<log::FoundPoses> poses = foreignPoses(log);
    if (!json) {
        printTable(log);
        if (!poses.empty())
            console::printResult("\ncould be the poses of a body in `insonify replay`:\n{}", log::makeTable(poses));
        if (metadata) printMetadata(log);
        return {};
    }
    Json all = infoJson(log);
    all["poses"] = posesJson(poses);
    if (metadata) all["metadata"] = metadataJson(log);
    return all;
}

/** Several logs are a list in JSON. */
int logInfo(const LogOptions& options) {
    Json all = Json::array();
    for (const std::string& file : options.files)
        all.push_back(printInfo(*opened(file), options.json, options.metadata));
    if (options.json) print(all.size() == 1 ? all.front() : all);
    return 0;
}

void makeFolder(const fs::path& folder) {
    std::error_code refused;
    fs::create_directories(folder, refused);
    if (!fs::is_directory(folder))
        throw types::ConfigError(folder, "--to", "is no folder and cannot be made: " + refused.message());
}

/** Makes the folder of an output file. */
void makeParentFolder(const fs::path& to) {
    if (to.has_parent_path()) makeFolder(to.parent_path());
}

/** Pings as text are about ten times as large as in the log, and slow to read. */
void noteSize(log::Reader& log, const std::string& stream, const fs::path& to) {
    constexpr double line = 40, reported_from = 1e8;  // [B]
    const size_t index = log.findIndex(stream);
    const log::Stream& pings = log.streams()[index];
    if (!log::holdsPings(pings) || pings.count == 0) return;
    types::Sonar ping;
    readPing(log, *std::ranges::find(log.samples(), index, &log::SampleRef::stream), ping);
    const double bins = static_cast<double>(ping.bins.size()) * static_cast<double>(pings.count);
    if (bins * line > reported_from)
        console::printDiagnostic(
            "notice: {} gets a line for each bin, some {:.0f} million, {:.1f} GB; an .npz takes {:.2g} GB\n",
            to.string(), bins / 1e6, bins * line / 1e9, bins * sizeof(float) / 1e9);
}

using Paths = std::vector<fs::path>;  ///< Written files.
/** A format that a stream is exported to, by the ending of the file, in lower case. */
struct ExportFormat {
    std::string_view ending;
    const char* limit = "";                                     ///< For the help.
    Paths (*write)(log::Reader&, const LogOptions&) = nullptr;  ///< Null: of whole logs, exportMessages().
};

Paths writeNpz(log::Reader& log, const LogOptions& options) {
    const log::Stream& stream = log.streams()[log.findIndex(options.stream)];
    return log::exportNpz(log, stream.name, options.to, text(readMeaning(log, stream)));
}

/** Writes text; soundings with their places on the earth where the log knows the datum. */
Paths writeCsv(log::Reader& log, const LogOptions& options) {
    noteSize(log, options.stream, options.to);
    std::optional<log::EarthColumns> earth;
    if (const auto datum = replay::recordedDatum(log)) earth = {*datum, options.utm};
    if (options.utm && !earth)
        throw types::ConfigError(log.path(), "--utm",
                                 "needs a datum, the world's origin on the earth: the deployment in the log has none");
    log::exportCsv(log, options.stream, options.to, earth);
    return {options.to};
}

Paths writePictures(log::Reader& log, const LogOptions& options) {
    Paths files = exportPictures(log, options.stream, options.to, options.ground);
    if (files.empty())
        throw types::ConfigError(log.path(), options.stream, "holds no sample; there is nothing to draw");
    return files;
}

constexpr ExportFormat export_formats[] = {
    {".npz", "", writeNpz},
    {".csv", "", writeCsv},
    {".png", "", writePictures},
    {".mcap"},
    {".xtf", " (side-scan)",
     [](log::Reader& log, const LogOptions& o) { return exportXtf(log, o.stream, o.poses, o.to), Paths{o.to}; }},
    {".oculus", "",
     [](log::Reader& log, const LogOptions& o) { return exportOculus(log, o.stream, o.to), Paths{o.to}; }},
};

Paths exportTo(log::Reader& log, LogOptions options) {
    const fs::path to = options.to;
    const log::Stream& stream = log.streams()[log.findIndex(options.stream)];
    options.stream = stream.name;
    const ExportFormat* const format = types::findFormat(export_formats, to);
    const std::string_view ending = format ? format->ending : "";
    if (options.ground && ending != ".png") throw types::ConfigError("", "--ground", "is for pictures: --to FILE.png");
    if (options.utm && (ending != ".csv" || !stream.holds<types::PointCloud>()))
        throw types::ConfigError("", "--utm", "is for soundings as text: --stream of points, --to FILE.csv");
    if (!to.has_extension() || fs::is_directory(to)) {
        makeFolder(to);
        options.to = to / (options.stream + ".npz");
        dropDamaged(log, options.stream);
        return writeNpz(log, options);
    }
    makeParentFolder(to);
    if (!format)
        throw types::ConfigError(to, "--to", "may be a folder, or end in " + types::alternativeEndings(export_formats));
    dropDamaged(log, options.stream);
    return format->write(log, options);
}

void reportLost(const log::Copied& copied) {
    for (const std::string& lost : copied.lost) console::printDiagnostic("lost: {}\n", lost);
}

int exportMessages(const LogOptions& options) {
    makeParentFolder(options.to);
    log::Selection selection;
    if (!options.stream.empty()) selection.streams.insert(options.stream);
    log::McapConfig mcap = options.mcap;
    mcap.is_bag = !log::isBesideAnotherBag(options.to);
    if (!mcap.is_bag)
        console::printDiagnostic(
            "notice: {}: the folder has the metadata.yaml of another bag, so this file gets none; "
            "`ros2 bag reindex` in a folder of its own makes it a bag\n",
            options.to);
    const std::vector<std::string> files = getFiles({options.file});
    const log::Copied copied =
        log::copyLog({files.begin(), files.end()}, options.to, {.selection = selection, .anew = mcap});
    reportLost(copied);
    console::printResult("{}: {} messages\n", options.to, copied.samples);
    return 0;
}

int logExport(const LogOptions& options) {
    if (log::isMcap(options.to)) return exportMessages(options);
    if (!options.for_mcap.empty())
        throw types::ConfigError("", options.for_mcap, "is for FILE.mcap; --to is " + options.to);
    const auto log = opened(options.file);
    if (options.stream.empty())
        throw types::ConfigError("", "--stream", "is missing; only an MCAP file takes all streams");
    for (const fs::path& written : exportTo(*log, options)) console::printResult("{}\n", written.string());
    return 0;
}

/** Parses "10:20": the numbers from 10 on, without 20; either number may be missing. */
void readRange(const std::string& text, log::Selection& selection) {
    const auto fail = [&] {
        throw types::ConfigError("", "--samples", "is " + text + "; it may be FIRST:LAST, either may be omitted");
    };
    const size_t colon = text.find(':');
    if (colon == text.npos) fail();
    const auto number = [&](std::string_view digits, size_t& value) {
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (!digits.empty() && (error != std::errc() || end != digits.data() + digits.size())) fail();
    };
    number(std::string_view(text).substr(0, colon), selection.first);
    number(std::string_view(text).substr(colon + 1), selection.last);
    if (selection.first >= selection.last)
        throw types::ConfigError("", "--samples", "is " + text + "; FIRST must be less than LAST");
}

/** Returns the first and last stamp of the files of a log; none: the files have no sample. */
std::optional<std::pair<types::Time, types::Time>> getSpan(const std::vector<std::string>& files) {
    std::optional<std::pair<types::Time, types::Time>> span;
    for (const std::string& file : files) {
        const auto log = log::openLog(file);
        if (log->samples().empty()) continue;
        if (!span) span.emplace(log->samples().front().time, types::Time{});
        span->second = log->samples().back().time;
    }
    return span;
}

log::Selection makeSelection(const LogOptions& options) {
    log::Selection selection;
    selection.streams = {options.streams.begin(), options.streams.end()};
    if (!options.from.empty() || !options.until.empty()) {
        const types::Time start = getSpan(options.files).value_or(std::pair<types::Time, types::Time>{}).first;
        for (const auto& [name, text] : {std::pair("--from", options.from), {"--until", options.until}})
            if (text.starts_with('-')) throw types::ConfigError("", name, "is " + text + "; must not be negative");
        if (!options.from.empty()) selection.from = log::readTime(options.from, "--from", start);
        if (!options.until.empty()) selection.until = log::readTime(options.until, "--until", start);
        if (selection.from >= selection.until)
            throw types::ConfigError("", "--until", "is " + options.until + "; must be after --from");
    }
    if (!options.samples.empty()) readRange(options.samples, selection);
    return selection;
}

void refuseOtherNames(const std::string& to) {
    if (!log::findLogFormat(to)) throw types::ConfigError(to, "--to", "must end in " + log::logEndings());
    if (fs::path(to).filename() == "properties.0.log")
        throw types::ConfigError(to, "--to", "is the name of a log of properties; give another");
}

/** Throws for a copy without a sample, which is not made. */
[[noreturn]] void refuseNothing(const LogOptions& options) {
    const auto span = getSpan(options.files);
    throw types::ConfigError(options.files.front(), "",
                             span ? fmt::format("none of its samples is in the requested part; they are from {} to {}",
                                                log::readable(span->first), log::readable(span->second))
                                  : "holds no sample");
}

/** Copies into `--to`, and reports what was lost. */
log::Copied copyTo(const std::string& to, const std::vector<fs::path>& files, const log::CopyOptions& options) {
    refuseOtherNames(to);
    makeParentFolder(to);
    log::Copied copied = log::copyLog(files, to, options);
    reportLost(copied);
    return copied;
}

/** Copies also the log of properties, and reports what was copied. */
int finish(const std::string& to, const fs::path& first, const log::Copied& copied) {
    if (const std::string notice = log::copyProperties(first, to); !notice.empty())
        console::printDiagnostic("notice: {}\n", notice);
    console::printResult(
        "{}: {} samples, {}\n", to, copied.samples,
        copied.lost.empty() ? "nothing was lost" : fmt::format("lost in {} places", copied.lost.size()));
    return 0;
}

/** Reports files of a log that begin before the previous file with one of their streams ends. */
void reportOverlaps(const std::vector<std::string>& files) {
    std::map<std::string, std::pair<types::Time, std::string>> ends;  // of each stream, and its file
    for (const std::string& file : files) {
        const auto log = log::openLog(file);
        std::set<std::string> seen;
        for (const log::SampleRef& at : log->samples()) {
            const std::string& stream = log->streams()[at.stream].name;
            const auto before = ends.find(stream);
            if (seen.insert(stream).second && before != ends.end() && at.time <= before->second.first) {
                console::printDiagnostic("notice: {} of {} begins before it ends in {}; the copy has both\n", stream,
                                         file, before->second.second);
                break;
            }
        }
        for (const log::SampleRef& at : log->samples()) ends[log->streams()[at.stream].name] = {at.time, file};
    }
}

int logCut(LogOptions options) {
    options.files = getFiles(options.files);
    if (options.files.size() > 1) reportOverlaps(options.files);
    const log::Copied copied = copyTo(options.to, {options.files.begin(), options.files.end()},
                                      {.selection = makeSelection(options), .needs_samples = true});
    if (copied.samples == 0) refuseNothing(options);
    return finish(options.to, options.files.front(), copied);
}

int logRepair(const LogOptions& options) {
    return finish(options.to, options.file,
                  copyTo(options.to, {fs::path(options.file)}, {.at_damage = log::AtDamage::Skip}));
}

int logImport(const LogOptions& options) {
    refuseOtherNames(options.to);
    makeParentFolder(options.to);
    std::optional<framework::DeploymentSpec> spec;
    if (!options.deployment.empty()) spec = framework::DeploymentSpec::load(deploymentIn(options.deployment));
    const Imported made = importRecording(options.file, std::move(spec), options.to);
    for (const std::string& notice : made.notices) console::printDiagnostic("notice: {}: {}\n", options.file, notice);
    for (const std::string& property : made.properties)
        console::printDiagnostic("notice: as recorded: {}\n", withShortLists(property));
    if (made.changes > 0)
        console::printDiagnostic("notice: settings change {} times; {}\n", made.changes,
                                 options.deployment.empty() ? "each ping has its own range and bins"
                                                            : "properties.0.log next to the log has them");
    console::printResult("{}: {} pings as {}\n", options.to, made.pings, made.stream);
    return 0;
}

Json verdictJson(const log::Verdict& verdict) {
    Json diagnostic;
    if (const auto& found = verdict.diagnostic)
        diagnostic = {{"file", found->file.string()}, {"byte", found->byte}, {"message", found->message}};
    return {{"valid", !verdict.diagnostic},
            {"streams", verdict.streams},
            {"samples", verdict.samples},
            {"set_backs", verdict.set_backs},
            {"wrong", diagnostic}};
}

int logCheck(const LogOptions& options) {
    const log::Verdict verdict = log::check(options.file);
    if (options.json) print(verdictJson(verdict));
    if (const auto& found = verdict.diagnostic)
        throw types::ConfigError(found->file, fmt::format("byte {}", found->byte), found->message);
    if (!options.json)
        console::printResult(
            "{}: valid, {} streams, {} samples{}\n", options.file, verdict.streams, verdict.samples,
            verdict.set_backs > 0
                ? fmt::format("; times go back {} times, which Rock's readers may refuse", verdict.set_backs)
                : "");
    return 0;
}

/** Adds an option for the messages of an MCAP file, named as the logger's properties. */
template <class E>
void addMcapOption(CLI::App& command, const std::string& name, const char* help, LogOptions& options, E& value) {
    const auto& names = types::EnumNames<E>::names;
    const auto take = [&options, &value, &names, name](const std::string& given) {
        const auto* found = std::ranges::find(names, given);
        if (found == std::end(names))
            throw types::ConfigError(
                "", name,
                fmt::format("is {}; {}may be {}", given, types::didYouMean(given, {std::begin(names), std::end(names)}),
                            fmt::join(names, ", ")));
        value = static_cast<E>(found - std::begin(names));
        options.for_mcap = name;
    };
    command.add_option_function<std::string>(name, take, help)->type_name(fmt::format("{{{}}}", fmt::join(names, ",")));
}

void addMcapOptions(CLI::App& command, LogOptions& options) {
    addMcapOption(command, "--dtype", "of echoes in an MCAP file (default: float32)", options, options.mcap.dtype);
    addMcapOption(command, "--world-frame", "of poses in an MCAP file (default: enu)", options,
                  options.mcap.world_frame);
}

/** Adds a subcommand of `log` that does `work`. */
template <class Work>
CLI::App* add(CLI::App& log, Action& action, const std::shared_ptr<LogOptions>& options, const char* name,
              const char* help, Work work) {
    CLI::App* command = log.add_subcommand(name, help);
    command->callback([options, &action, work] { action = [options, work] { return work(*options); }; });
    return command;
}

}  // namespace

void addLogCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<LogOptions>();
    CLI::App* log = app.add_subcommand("log", "Inspects, cuts and repairs logs")->require_subcommand(1);

    CLI::App* info = add(*log, action, options, "info", "Streams, types, counts, time span and rate", logInfo);
    info->add_flag("--json", options->json, "for machines");
    info->add_flag("--metadata", options->metadata, "deployment, seed and plan, and what the numbers mean, with units");

    CLI::App* out =
        add(*log, action, options, "export",
            "Writes a stream as numpy arrays, text, pictures, XTF or .oculus, or the log as ROS 2 messages", logExport);
    out->add_option("--stream", options->stream, "task.port, as `log info` lists them; none: all, to an MCAP file");
    out->add_option("--pose", options->poses, "of an XTF file: task.port of the sonar's poses, or its vehicle's");
    std::string files;
    for (const ExportFormat& format : export_formats) files += fmt::format("FILE{}{}, ", format.ending, format.limit);
    out->add_option("--to", options->to, files + "or a folder for FILE.npz")->required();
    out->add_flag("--ground", options->ground,
                  "a side-scan's pictures along a flat bottom, each line by the log's altitude at its time");
    out->add_flag("--utm", options->utm, "soundings as text on the map of UTM, in place of latitudes and longitudes");
    addMcapOptions(*out, *options);

    CLI::App* cut = add(*log, action, options, "cut", "Copies a part of a log, or its files into one", logCut);
    cut->add_option("FILE", options->files, "a pocolog, MCAP or .db3 file, or those of a log in order")->required();
    cut->add_option("--to", options->to, "the new log, NAME.0.log or NAME.0.mcap")->required();
    cut->add_option("--from", options->from,
                    "earliest time: seconds after the log's first stamp, or a date, as in 2026-11-22T12:55:44Z");
    cut->add_option("--until", options->until, "time at which the copy ends, not included; as for --from");
    cut->add_option("--samples", options->samples, "FIRST:LAST, numbers from 0 in the kept streams, LAST not included");
    cut->add_option("--stream", options->streams, "task.port to keep; may be given again; none: all")
        ->allow_extra_args(false);

    CLI::App* import =
        add(*log, action, options, "import",
            "Makes a log of a recording of another program or device, to be exported, replayed and scored", logImport);
    import->add_option("FILE", options->file, recordingHelp())->required();
    import->add_option("DEPLOYMENT", options->deployment,
                       "whose receiver's pings they become; a recording without poses gets its trajectories; none: the "
                       "log has only the file's data");
    import->add_option("--to", options->to, "the new log, NAME.0.log or NAME.0.mcap")->required();

    CLI::App* repair =
        add(*log, action, options, "repair",
            "Copies the intact parts of a damaged log into a new log, and reports what was lost", logRepair);
    repair->add_option("--to", options->to, "the new log, NAME.0.log or NAME.0.mcap")->required();

    CLI::App* check =
        add(*log, action, options, "check", "Reads a log strictly and names the first wrong byte", logCheck);
    check->add_flag("--json", options->json, "for machines");

    info->add_option("FILE", options->files, "logs: pocolog, MCAP or .db3 files, or folders of bags")->required();
    for (CLI::App* command : {out, repair, check})
        command->add_option("FILE", options->file, "a pocolog, MCAP or .db3 file, or the folder of a bag")->required();
}

}  // namespace insonify::command
