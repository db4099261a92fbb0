#pragma once
// Scenes by recipe: the package insonify_worlds, which runs in a separate process of Python.
#include <string>
#include <vector>

namespace insonify::worlds {

/** Environment variable with the Python to run, instead of searching one. */
inline constexpr const char* python_variable = "INSONIFY_PYTHON";

/** Runs the package with options of `insonify scene make`: {"--recipe", "bay.yml", "--out", "bay.glb"}. Prints the
 *  output of the package. Throws types::ConfigError with the package's error for a wrong recipe, or with what to
 *  install if no Python has the packages. */
void generate(const std::vector<std::string>& options);

/** Returns the SHA-256 of the package's sources: other sources may make other scenes of the same recipe and seed. */
std::string generatorDigest();

}  // namespace insonify::worlds
