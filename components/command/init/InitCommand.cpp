// insonify init DIR [--sonar NAME]
#include <fmt/core.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

#include "components/command/CommandLine.hpp"
#include "components/command/init/Starter.hpp"
#include "components/console/Console.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::command {

namespace fs = std::filesystem;
namespace {

struct NewFile {
    fs::path path;
    std::string_view bytes;
};

/** Throws a diagnostic for each file that exists already: nothing is overwritten. */
void refuseOverwriting(const std::vector<NewFile>& files) {
    types::Diagnostics diagnostics;
    for (const NewFile& file : files)
        if (fs::symlink_status(file.path).type() != fs::file_type::not_found)
            diagnostics.push_back(
                {"", "exists already; init overwrites nothing, name another folder", file.path.string()});
    if (!diagnostics.empty()) throw types::ConfigError(std::move(diagnostics));
}

/** Makes a file that is not there yet, not even since it was looked for; `made` receives its name. */
void write(const NewFile& file, std::vector<fs::path>& made) {
    std::FILE* const stream = std::fopen(file.path.c_str(), "wbx");
    if (stream) made.push_back(file.path);
    bool is_written = stream && std::fwrite(file.bytes.data(), 1, file.bytes.size(), stream) == file.bytes.size();
    if (stream) is_written = std::fclose(stream) == 0 && is_written;
    if (!is_written)
        throw types::ConfigError(file.path.string(), "",
                                 "cannot be written: " + std::generic_category().message(errno));
}

/** Writes all files, or none. */
void write(const std::vector<NewFile>& files) {
    std::vector<fs::path> made;
    try {
        for (const NewFile& file : files) write(file, made);
    } catch (...) {
        std::error_code ignored;
        for (const fs::path& file : made) fs::remove(file, ignored);
        throw;
    }
}

int init(const fs::path& folder, const std::string& sonar) {
    const sonars::SonarFigures& figures = starterSonar(sonar);
    const std::string deployment = starterDeployment(figures);
    const std::vector<StarterFile> others = starterFiles(figures);
    std::vector<NewFile> files{{folder / (figures.name + ".yml"), deployment}};
    for (const StarterFile& file : others) files.push_back({folder / file.name, file.bytes});
    refuseOverwriting(files);
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder))
        throw types::ConfigError(folder.string(), "", "is no folder and cannot be made: " + error.message());
    write(files);
    fs::permissions(folder / "make_scene.py", fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                    fs::perm_options::add, error);
    for (const NewFile& file : files) console::printResult("{}\n", file.path.string());
    const std::string word = console::shellWord(folder.string());
    console::printResult("next: insonify run {}\n", word);
    if (figures.isFan())
        console::printResult("or:   insonify dataset {} --sweep {} --out set\n", word,
                             console::shellWord((folder / "sweep.yml").string()));
    return 0;
}

}  // namespace

void describeSonars(CLI::App& init) {
    std::string names;
    for (const sonars::SonarFigures* sonar : starterSonars()) names += (names.empty() ? "" : ", ") + sonar->name;
    init.get_option("--sonar")->description("one of " + names)->default_str(starterSonars().front()->name);
}

void addInitCommand(CLI::App& app, Action& action) {
    struct Options {
        std::string folder;
        std::optional<std::string> sonar;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("init", "Makes a folder with a first deployment, its scene, trajectories and sweep");
    command->add_option("DIR", options->folder, "a folder, made if it is not there")->required();
    command->add_option("--sonar", options->sonar)->type_name("NAME");
    command->preparse_callback([command](size_t) { describeSonars(*command); });
    command->callback([options, &action] {
        action = [options] { return init(options->folder, options->sonar.value_or(starterSonars().front()->name)); };
    });
}

}  // namespace insonify::command
