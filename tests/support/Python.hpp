#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace insonify {

/** Debian's python has Debian's numpy; another one in the path may have none. */
inline std::string python() { return std::filesystem::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3"; }

/** What python prints when called with these arguments, or that it failed and why; `answer` is written on the way. */
inline std::string pythonSays(const std::string& arguments, const std::filesystem::path& answer) {
    const int status = std::system((python() + " " + arguments + " > " + answer.string() + " 2>&1").c_str());
    std::ifstream file(answer);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return status == 0 ? text : "python failed: " + text;
}

}  // namespace insonify
