// insonify init DIR [--sonar NAME]
#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <system_error>

#include "components/deployer/CommandLine.hpp"
#include "components/deployer/Starter.hpp"
#include "types/ConfigError.hpp"

namespace insonify::deployer {
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

void write(const NewFile& file) {
    std::ofstream stream(file.path, std::ios::binary);
    stream << file.bytes;
    if (!stream.flush())
        throw types::ConfigError(file.path.string(), "", "cannot be written: " + std::system_category().message(errno));
}

/** Writes all files, or none. */
void write(const std::vector<NewFile>& files) try {
    for (const NewFile& file : files) write(file);
} catch (...) {
    std::error_code ignored;
    for (const NewFile& file : files) fs::remove(file.path, ignored);
    throw;
}

/** Returns a text as a word of the shell: in quotes if it has letters with a meaning there. */
std::string shellWord(const std::string& text) {
    const auto isPlain = [](unsigned char c) { return std::isalnum(c) || c >= 0x80 || std::strchr("/._-+,:@%", c); };
    if (!text.empty() && std::ranges::all_of(text, isPlain)) return text;
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
    return word + "'";
}

int init(const fs::path& folder, const std::string& sonar) {
    const SonarPreset& preset = sonarPreset(sonar);
    const std::string deployment = starterDeployment(preset);
    std::vector<NewFile> files{{folder / (std::string(preset.name) + ".yml"), deployment}};
    for (const StarterFile& file : starterFiles(preset)) files.push_back({folder / file.name, file.bytes});
    refuseOverwriting(files);
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder))
        throw types::ConfigError(folder.string(), "", "is no folder and cannot be made: " + error.message());
    write(files);
    fs::permissions(folder / "make_scene.py", fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                    fs::perm_options::add, error);
    for (const NewFile& file : files) fmt::print("{}\n", file.path.string());
    const std::string word = shellWord(folder.string());
    fmt::print("next: insonify run {}\n", word);
    if (preset.isFan())
        fmt::print("or:   insonify dataset {} --sweep {} --out set\n", word,
                   shellWord((folder / "sweep.yml").string()));
    return 0;
}

std::string presetNames() {
    std::string names;
    for (const SonarPreset& preset : sonarPresets()) names += (names.empty() ? "" : ", ") + std::string(preset.name);
    return names;
}

}  // namespace

void addInitCommand(CLI::App& app, Action& action) {
    struct Options {
        std::string folder, sonar = sonarPresets().front().name;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("init", "Makes a folder with a first deployment, its scene, trajectories and sweep");
    command->add_option("DIR", options->folder, "a folder, made if it is not there")->required();
    command->add_option("--sonar", options->sonar, "one of " + presetNames())->type_name("NAME")->capture_default_str();
    command->callback([options, &action] { action = [options] { return init(options->folder, options->sonar); }; });
}

}  // namespace insonify::deployer
