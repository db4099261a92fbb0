#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/Paths.hpp"

namespace insonify {

/** Returns the Python to use. That of scripts/setup has all packages of the tests; Debian's python has Debian's numpy;
 *  another in the path may have none. */
inline std::string python() {
    for (const std::string& candidate : {test::sourceFile("build/venv/bin/python3"), std::string("/usr/bin/python3")})
        if (std::filesystem::exists(candidate)) return candidate;
    return "python3";
}

/** Returns whether python can import these modules: "rosbags, mcap". */
inline bool pythonHas(const std::string& modules) {
    return std::system((python() + " -c 'import " + modules + "' 2> /dev/null").c_str()) == 0;
}

/** Returns the output of python with these arguments, or that it failed and why. The output is written to `answer`
 *  too. */
inline std::string pythonSays(const std::string& arguments, const std::filesystem::path& answer) {
    const int status = std::system((python() + " " + arguments + " > " + answer.string() + " 2>&1").c_str());
    std::ifstream file(answer);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return status == 0 ? text : "python failed: " + text;
}

}  // namespace insonify
