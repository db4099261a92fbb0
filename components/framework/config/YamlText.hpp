#pragma once
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>
#include <vector>

namespace insonify::framework {

/** Returns the bytes of a file. Throws types::ConfigError when it cannot be read; `what` names the expected kind: "a
 *  deployment file". */
std::string readFile(const std::filesystem::path& file, const std::string& what);

/** Whether the bytes are UTF-8 without a NUL. */
bool isText(std::string_view bytes);

/** Returns the YAML documents of a text. Throws types::ConfigError with the place in `file` when the text is not
 *  YAML. */
std::vector<YAML::Node> parseYaml(const std::string& text, const std::string& file);
/** Returns one separate value, as on a command line. Empty text is null. Throws types::ConfigError without a place when
 *  there is no single value. */
YAML::Node parseValue(const std::string& text);

}  // namespace insonify::framework
