#pragma once
// Scenes by recipe: the package insonify_worlds, which Python runs in a process of its own.
#include <filesystem>
#include <string>
#include <vector>

namespace insonify::worlds {

/** Environment variable that names the Python to run, in place of those that are looked for. */
inline constexpr const char* python_variable = "INSONIFY_PYTHON";

/** Runs the package with options of `insonify scene make`: {"--recipe", "bay.yml", "--out", "bay.glb"}. Prints what the
 *  package prints. Throws types::ConfigError with its error for a wrong recipe, or with what to install where no Python
 *  has numpy, PyYAML and manifold3d; std::runtime_error where Python fails otherwise. */
void generate(const std::vector<std::string>& options);

/** SHA-256 of the package's sources: another one may make other scenes of the same recipe and seed. */
std::string generatorDigest();

}  // namespace insonify::worlds
