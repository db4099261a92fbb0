#pragma once
// Bytes as Gazebo Harmonic puts them on the wire, by its own message definitions: see make_recordings.py.
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/Paths.hpp"

namespace insonify::gazebo {

inline std::string recording(const std::string& name) {
    std::ifstream file(test::sourceFile("tests/fuzz/corpus/gazebo/harmonic_" + name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace insonify::gazebo
