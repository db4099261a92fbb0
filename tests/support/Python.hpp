#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/Paths.hpp"

namespace insonify {

/** That of scripts/setup has all that the tests use; Debian's python has Debian's numpy; another one in the path may
 *  have none. */
inline std::string python() {
    for (const std::string& candidate : {test::sourceFile("build/venv/bin/python3"), std::string("/usr/bin/python3")})
        if (std::filesystem::exists(candidate)) return candidate;
    return "python3";
}

/** Whether python can import these modules: "rosbags, mcap". */
inline bool pythonHas(const std::string& modules) {
    return std::system((python() + " -c 'import " + modules + "' 2> /dev/null").c_str()) == 0;
}

/** What python prints when called with these arguments, or that it failed and why; `answer` is written on the way. */
inline std::string pythonSays(const std::string& arguments, const std::filesystem::path& answer) {
    const int status = std::system((python() + " " + arguments + " > " + answer.string() + " 2>&1").c_str());
    std::ifstream file(answer);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return status == 0 ? text : "python failed: " + text;
}

}  // namespace insonify
