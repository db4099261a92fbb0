// insonify examples
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include "components/command/CommandLine.hpp"
#include "components/console/Console.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::command {

namespace fs = std::filesystem;
namespace {

/** Returns the first sentence of the comment that a deployment begins with. */
std::string purpose(const fs::path& file) {
    std::ifstream stream(file);
    std::string text;
    for (std::string line; std::getline(stream, line) && line.starts_with("# ");)
        text += (text.empty() ? "" : " ") + line.substr(2);
    const size_t end = std::min(text.find(". "), text.find(": "));
    return end == text.npos ? text : text.substr(0, end);
}

int listExamples() {
    const fs::path shared = loader::sharedFolder();
    if (shared.empty()) throw types::ConfigError("", "examples", "are not part of this installation");
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(shared / "deploy"))
        if (entry.path().extension() == ".yml") files.push_back(entry.path());
    std::ranges::sort(files);
    for (const fs::path& file : files)
        console::printResult("{:32} {}\n", file.lexically_relative(shared).string(), purpose(file));
    console::printResult(
        "They are in {}. Any command takes them as deploy/NAME.yml, from every folder without a deploy of its own.\n",
        shared.string());
    return 0;
}

}  // namespace

void addExamplesCommand(CLI::App& app, Action& action) {
    CLI::App* command = app.add_subcommand("examples", "Lists the deployments that are installed as examples");
    command->callback([&action] { action = listExamples; });
}

}  // namespace insonify::command
