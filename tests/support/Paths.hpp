#pragma once
// The folders of this build. Only Paths.cpp is compiled with their names, so that every other object of the tests is
// the same in each clone, and clones share it by the compiler cache.
#include <string>

namespace insonify::test {

extern const char source_dir[];   ///< The repository.
extern const char build_dir[];    ///< This build.
extern const char bin_dir[];      ///< Its programs.
extern const char shared_data[];  ///< Recordings and scenes next to the repository, which may be absent.

/** Returns the path of a file of the repository: sourceFile("deploy/minimal.yml"). */
inline std::string sourceFile(const std::string& name) { return std::string(source_dir) + "/" + name; }

/** Returns the path of a file of the shared data. */
inline std::string sharedFile(const std::string& name) { return std::string(shared_data) + "/" + name; }

/** Returns the path of a program of this build: program("insonify"). */
inline std::string program(const std::string& name) { return std::string(bin_dir) + "/" + name; }

}  // namespace insonify::test
