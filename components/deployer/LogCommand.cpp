// insonify log info FILE, insonify log export FILE --stream S --to DIR|FILE.{npz,csv,png}
#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "components/deployer/Commands.hpp"
#include "components/deployer/FanExport.hpp"
#include "components/deployer/Json.hpp"
#include "components/pocolog/Export.hpp"
#include "components/pocolog/Info.hpp"

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

int logInfo(const std::string& file, bool json) {
    const pocolog::Reader log(file);
    if (!log.complete()) fmt::print(stderr, "notice: {}: {}\n", file, log.fault());
    const pocolog::LogInfo info = pocolog::info(log);
    json ? print(infoJson(info)) : printTable(file, info);
    return 0;
}

void refuseMissingFolder(const fs::path& to) {
    const fs::path folder = to.has_parent_path() ? to.parent_path() : ".";
    if (!fs::is_directory(folder)) throw types::ConfigError(folder, "--to", "is no folder");
}

/** The files that were written. */
std::vector<fs::path> exportTo(pocolog::Reader& log, const std::string& stream, const fs::path& to) {
    log.indexOf(stream);
    if (!to.has_extension() || fs::is_directory(to)) {
        fs::create_directories(to);
        return pocolog::exportNpz(log, stream, to / (stream + ".npz"));
    }
    refuseMissingFolder(to);
    if (to.extension() == ".npz") return pocolog::exportNpz(log, stream, to);
    if (to.extension() == ".png") return exportFans(log, stream, to);
    if (to.extension() != ".csv") throw types::ConfigError(to, "--to", "may be a folder, or end in .npz, .csv or .png");
    pocolog::exportCsv(log, stream, to);
    return {to};
}

int logExport(const std::string& file, const std::string& stream, const std::string& to) {
    pocolog::Reader log(file);
    if (!log.complete()) fmt::print(stderr, "notice: {}: {}\n", file, log.fault());
    for (const fs::path& written : exportTo(log, stream, to)) fmt::print("{}\n", written.string());
    return 0;
}

struct Options {
    std::string file, stream, to;
    bool json = false;
};

}  // namespace

void addLogCommand(CLI::App& app, Action& action) {
    const auto options = std::make_shared<Options>();
    CLI::App* log = app.add_subcommand("log", "Looks into a log")->require_subcommand(1);

    CLI::App* info = log->add_subcommand("info", "Streams, types, counts, time span and rate");
    info->add_option("FILE", options->file, "a pocolog file")->required();
    info->add_flag("--json", options->json, "for machines");
    info->callback([options, &action] { action = [options] { return logInfo(options->file, options->json); }; });

    CLI::App* out = log->add_subcommand("export", "Writes a stream as numpy arrays, text or fan pictures");
    out->add_option("FILE", options->file, "a pocolog file")->required();
    out->add_option("--stream", options->stream, "task.port, as `log info` lists them")->required();
    out->add_option("--to", options->to, "FILE.npz, FILE.csv, FILE.png, or a folder for FILE.npz")->required();
    out->callback(
        [options, &action] { action = [options] { return logExport(options->file, options->stream, options->to); }; });
}

}  // namespace insonify::deployer
