// insonify log info|export|cut|repair|check FILE
#include <fmt/core.h>

#include <charconv>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "components/deployer/Commands.hpp"
#include "components/deployer/Json.hpp"
#include "components/deployer/PictureExport.hpp"
#include "components/deployer/StreamMeaning.hpp"
#include "components/mcap/Export.hpp"
#include "components/mcap/LogSource.hpp"
#include "components/pocolog/Check.hpp"
#include "components/pocolog/Copy.hpp"
#include "components/pocolog/Export.hpp"
#include "components/pocolog/Info.hpp"
#include "components/pocolog/Pings.hpp"

namespace insonify::deployer {
namespace fs = std::filesystem;
namespace {

Json infoJson(const pocolog::LogInfo& info) {
    Json streams = Json::array();
    for (const pocolog::StreamInfo& stream : info.streams)
        streams.push_back({{"name", stream.name},
                           {"type", stream.type},
                           {"count", stream.count},
                           {"first_s", stream.first_s},
                           {"last_s", stream.last_s},
                           {"rate_hz", stream.rate_hz}});
    return {{"bytes", info.bytes}, {"complete", info.complete}, {"streams", streams}};
}

void printTable(const std::string& file, const pocolog::LogInfo& info) {
    fmt::print("{}: {} bytes, {}\n", file, info.bytes, info.complete ? "complete" : "cut off");
    fmt::print("  {:24} {:32} {:>8} {:>12} {:>12} {:>9}\n", "stream", "type", "samples", "first s", "last s",
               "rate Hz");
    for (const pocolog::StreamInfo& s : info.streams)
        fmt::print("  {:24} {:32} {:>8} {:>12.3f} {:>12.3f} {:>9.2f}\n", s.name, s.type, s.count, s.first_s, s.last_s,
                   s.rate_hz);
}

/** What each stream carries: the deployment, the seed and the plan, which the streams of a run share, and what its
 *  numbers mean. */
Json metadataJson(const pocolog::Reader& log) {
    Json all = Json::object();
    for (const pocolog::Stream& stream : log.streams())
        all[stream.name] = {{"metadata", stream.metadata}, {"meaning", meaningOf(log, stream)}};
    return all;
}

void printMetadata(const pocolog::Reader& log) {
    std::set<std::pair<std::string, std::string>> told;  // once for all streams that have the same
    for (const pocolog::Stream& stream : log.streams()) {
        fmt::print("\n{}\n{}\n", stream.name, text(meaningOf(log, stream)));
        for (const auto& [key, value] : stream.metadata)
            if (told.emplace(key, value).second)
                fmt::print("{}:{}{}\n", key, value.find('\n') == value.npos ? " " : "\n", value);
    }
}

int logInfo(const std::string& file, bool json, bool metadata) {
    const auto log = mcap::openLog(file);
    if (!log->complete()) fmt::print(stderr, "notice: {}: {}\n", file, log->fault());
    const pocolog::LogInfo info = pocolog::info(*log);
    if (!json) {
        printTable(file, info);
        if (metadata) printMetadata(*log);
        return 0;
    }
    Json all = infoJson(info);
    if (metadata) all["metadata"] = metadataJson(*log);
    print(all);
    return 0;
}

void refuseMissingFolder(const fs::path& to) {
    const fs::path folder = to.has_parent_path() ? to.parent_path() : ".";
    if (!fs::is_directory(folder)) throw types::ConfigError(folder, "--to", "is no folder");
}

/** Pings as text are some ten times as large as they are in the log, and slow to read. */
void noteSize(const pocolog::Reader& log, const std::string& stream, const fs::path& to) {
    constexpr double line = 40, told_from = 1e8;  // [B]
    if (!pocolog::holdsPings(log.streams()[log.indexOf(stream)])) return;
    double bins = 0;
    log.forEachRef(stream, [&](const pocolog::SampleRef& at) { bins += at.size / static_cast<double>(sizeof(float)); });
    if (bins * line > told_from)
        fmt::print(stderr,
                   "notice: {} gets a line for each bin, some {:.0f} million, {:.1f} GB; an .npz takes {:.2g} GB\n",
                   to.string(), bins / 1e6, bins * line / 1e9, bins * sizeof(float) / 1e9);
}

/** The files that were written. */
std::vector<fs::path> exportTo(pocolog::Reader& log, const std::string& stream, const fs::path& to) {
    const std::string meta = text(meaningOf(log, log.streams()[log.indexOf(stream)]));
    if (!to.has_extension() || fs::is_directory(to)) {
        fs::create_directories(to);
        return pocolog::exportNpz(log, stream, to / (stream + ".npz"), meta);
    }
    refuseMissingFolder(to);
    if (to.extension() == ".npz") return pocolog::exportNpz(log, stream, to, meta);
    if (to.extension() == ".png") return exportPictures(log, stream, to);
    if (to.extension() != ".csv")
        throw types::ConfigError(to, "--to", "may be a folder, or end in .npz, .csv, .png or .mcap");
    noteSize(log, stream, to);
    pocolog::exportCsv(log, stream, to);
    return {to};
}

struct Options {
    std::string file, stream, to, samples;
    std::vector<std::string> files, streams;
    std::optional<double> from, until;
    mcap::McapConfig mcap;
    bool json = false, metadata = false;
};

int logExport(const Options& options) {
    const auto log = mcap::openLog(options.file);
    if (!log->complete()) fmt::print(stderr, "notice: {}: {}\n", options.file, log->fault());
    if (mcap::isMcap(options.to)) {
        refuseMissingFolder(options.to);
        const size_t samples = mcap::exportLog(*log, options.stream, options.to, options.mcap);
        fmt::print("{}: {} messages\n", options.to, samples);
        return 0;
    }
    if (options.stream.empty())
        throw types::ConfigError("", "--stream", "is missing; only an MCAP file takes all streams");
    for (const fs::path& written : exportTo(*log, options.stream, options.to)) fmt::print("{}\n", written.string());
    return 0;
}

/** "10:20", either number may be missing: the numbers from 10 on, without 20. */
void readRange(const std::string& text, pocolog::Selection& selection) {
    const auto fail = [&] {
        throw types::ConfigError("", "--samples", "is " + text + "; it may be FIRST:LAST, either may be left out");
    };
    const size_t colon = text.find(':');
    if (colon == text.npos) fail();
    const auto number = [&](std::string_view digits, size_t& value) {
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (!digits.empty() && (error != std::errc() || end != digits.data() + digits.size())) fail();
    };
    number(std::string_view(text).substr(0, colon), selection.first);
    number(std::string_view(text).substr(colon + 1), selection.last);
}

pocolog::Selection selectionOf(const Options& options) {
    pocolog::Selection selection;
    selection.streams = {options.streams.begin(), options.streams.end()};
    if (options.from) selection.from = types::Time::fromSeconds(*options.from);
    if (options.until) selection.until = types::Time::fromSeconds(*options.until);
    if (!options.samples.empty()) readRange(options.samples, selection);
    return selection;
}

void printCopied(const pocolog::Copied& copied, const std::string& to) {
    for (const std::string& lost : copied.lost) fmt::print(stderr, "lost: {}\n", lost);
    fmt::print("{}: {} samples, {}\n", to, copied.samples,
               copied.lost.empty() ? "nothing was lost" : fmt::format("lost in {} places", copied.lost.size()));
}

int logCut(const Options& options) {
    const pocolog::Selection selection = selectionOf(options);
    refuseMissingFolder(options.to);
    const std::vector<fs::path> files(options.files.begin(), options.files.end());
    printCopied(pocolog::copy(files, pocolog::AtDamage::Stop, selection, options.to), options.to);
    return 0;
}

int logRepair(const Options& options) {
    refuseMissingFolder(options.to);
    printCopied(pocolog::copy({options.file}, pocolog::AtDamage::Skip, {}, options.to), options.to);
    return 0;
}

Json verdictJson(const pocolog::Verdict& verdict) {
    Json wrong;
    if (verdict.wrong)
        wrong = {
            {"file", verdict.wrong->file.string()}, {"byte", verdict.wrong->byte}, {"message", verdict.wrong->what}};
    return {{"valid", !verdict.wrong}, {"streams", verdict.streams}, {"samples", verdict.samples}, {"wrong", wrong}};
}

int logCheck(const Options& options) {
    const pocolog::Verdict verdict = mcap::checkLog(options.file);
    if (options.json) print(verdictJson(verdict));
    if (const auto& wrong = verdict.wrong)
        throw types::ConfigError(wrong->file, fmt::format("byte {}", wrong->byte), wrong->what);
    if (!options.json)
        fmt::print("{}: valid, {} streams, {} samples\n", options.file, verdict.streams, verdict.samples);
    return 0;
}

/** How messages of an MCAP file look, by the names of the logger's properties. */
template <class E>
void addEnum(CLI::App& command, const char* name, const char* help, E& value) {
    std::map<std::string, E> names;
    for (size_t i = 0; i < std::size(types::EnumNames<E>::names); ++i)
        names[std::string(types::EnumNames<E>::names[i])] = static_cast<E>(i);
    command.add_option(name, value, help)->transform(CLI::CheckedTransformer(names));
}

void addMcapOptions(CLI::App& command, mcap::McapConfig& config) {
    addEnum(command, "--dtype", "of echoes in an MCAP file (default: float32)", config.dtype);
    addEnum(command, "--world-frame", "of poses in an MCAP file (default: as_is)", config.world_frame);
}

/** A subcommand of `log` that does `work`. */
template <class Work>
CLI::App* add(CLI::App& log, Action& action, const std::shared_ptr<Options>& options, const char* name,
              const char* help, Work work) {
    CLI::App* command = log.add_subcommand(name, help);
    command->callback([options, &action, work] { action = [options, work] { return work(*options); }; });
    return command;
}

}  // namespace

void addLogCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<Options>();
    CLI::App* log = app.add_subcommand("log", "Looks into a log, cuts and mends it")->require_subcommand(1);

    CLI::App* info = add(*log, action, options, "info", "Streams, types, counts, time span and rate",
                         [](const Options& asked) { return logInfo(asked.file, asked.json, asked.metadata); });
    info->add_flag("--json", options->json, "for machines");
    info->add_flag("--metadata", options->metadata, "deployment, seed and plan, and what the numbers mean, with units");

    CLI::App* out = add(*log, action, options, "export",
                        "Writes a stream as numpy arrays, text or pictures, or the log as ROS 2 messages", logExport);
    out->add_option("--stream", options->stream, "task.port, as `log info` lists them; none: all, to an MCAP file");
    out->add_option("--to", options->to, "FILE.npz, FILE.csv, FILE.png, FILE.mcap, or a folder for FILE.npz")
        ->required();
    addMcapOptions(*out, options->mcap);

    CLI::App* cut = add(*log, action, options, "cut", "Copies a part of a log, or its files into one", logCut);
    cut->add_option("FILE", options->files, "a pocolog file, or those of a log in order")->required();
    cut->add_option("--to", options->to, "the new log, NAME.0.log")->required();
    cut->add_option("--from", options->from, "earliest time, as `log info` lists them [s]");
    cut->add_option("--until", options->until, "time at which the copy ends, not included [s]");
    cut->add_option("--samples", options->samples, "FIRST:LAST, numbers from 0 in the kept streams, LAST not included");
    cut->add_option("--stream", options->streams, "task.port to keep; may be given again; none: all")
        ->allow_extra_args(false);

    CLI::App* repair = add(*log, action, options, "repair",
                           "Copies what is whole of a damaged log into a new one, and tells what was lost", logRepair);
    repair->add_option("--to", options->to, "the new log, NAME.0.log")->required();

    CLI::App* check =
        add(*log, action, options, "check", "Reads a log strictly and names the first wrong byte", logCheck);
    check->add_flag("--json", options->json, "for machines");

    for (CLI::App* command : {info, out, repair, check})
        command->add_option("FILE", options->file, command == repair ? "a pocolog file" : "a pocolog or MCAP file")
            ->required();
}

}  // namespace insonify::deployer
