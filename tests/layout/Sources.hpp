#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/Paths.hpp"

namespace insonify::layout {

/** One source file of the project: path from the root with '/' between the parts, and its lines. */
struct Source {
    std::string path;
    std::vector<std::string> lines;

    /** "sonar" for components/sonar/..., else the first folder ("types"). */
    std::string folder() const {
        const std::string below = path.starts_with("components/") ? path.substr(11) : path;
        return below.substr(0, below.find('/'));
    }
    std::string stem() const { return std::filesystem::path(path).stem(); }
    bool isTaskHalf() const { return stem().ends_with("Task"); }
    /** True for a file of a component's own part of the command. */
    bool isCommandHalf() const { return path.find("/commands/") != std::string::npos; }
    /** True for the entry of a component library. */
    bool isLibraryEntry() const { return stem() == "Library"; }
};

inline Source readSource(const std::filesystem::path& file) {
    Source source{std::filesystem::relative(file, test::source_dir).generic_string(), {}};
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) source.lines.push_back(line);
    return source;
}

/** All files below `folder` (from the root) with one of the extensions. */
inline std::vector<Source> sourcesIn(const std::string& folder, const std::vector<std::string>& extensions) {
    std::vector<Source> found;
    const std::filesystem::path root = std::filesystem::path(test::source_dir) / folder;
    if (!std::filesystem::exists(root)) return found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
        if (std::ranges::count(extensions, entry.path().extension().string()))
            found.push_back(readSource(entry.path()));
    return found;
}

struct Include {
    std::string target;
    bool ours = false;  ///< In quotes, from the root.
};

inline std::vector<Include> includes(const Source& source) {
    std::vector<Include> found;
    for (const std::string& line : source.lines) {
        if (!line.starts_with("#include ")) continue;
        const bool ours = line[9] == '"';
        found.push_back({line.substr(10, line.find_first_of(ours ? "\"" : ">", 10) - 10), ours});
    }
    return found;
}

}  // namespace insonify::layout
