#pragma once
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>
#include <vector>

namespace insonify::framework {

/** The bytes of a file; types::ConfigError when it cannot be read. `what` it must be: "a deployment file". */
std::string readFile(const std::filesystem::path& file, const std::string& what);

/** Whether it is UTF-8 without a NUL. */
bool isText(std::string_view bytes);

/** The documents of a text in YAML; types::ConfigError with the place in `file` when it is not. */
std::vector<YAML::Node> parseYaml(const std::string& text, const std::string& file);
/** One value that stands by itself, as on a command line; types::ConfigError without a place when it is none, or
 *  several. Empty text is null. */
YAML::Node parseValue(const std::string& text);

}  // namespace insonify::framework
