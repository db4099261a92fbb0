#include "components/framework/YamlText.hpp"

#include <yaml-cpp/depthguard.h>

#include <fstream>
#include <sstream>

#include "components/framework/YamlDocuments.hpp"
#include "types/ConfigError.hpp"

namespace insonify::framework {

std::string readFile(const std::filesystem::path& file, const std::string& what) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error))
        throw types::ConfigError(file.string(), "", "is a directory; must be " + what);
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw types::ConfigError(file.string(), "", "cannot be opened; must be " + what);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
}

bool isText(std::string_view bytes) {
    size_t following = 0;
    for (const unsigned char c : bytes) {
        if (c == 0 || (following > 0) != ((c & 0xC0) == 0x80)) return false;
        if (following > 0)
            --following;
        else if (c >= 0xF8)
            return false;
        else
            following = c >= 0xF0 ? 3 : c >= 0xE0 ? 2 : c >= 0xC0 ? 1 : 0;
    }
    return following == 0;
}

std::vector<YAML::Node> parseYaml(const std::string& text, const std::string& file) {
    if (!isText(text)) throw types::ConfigError(file, "", "is not text; must be YAML in UTF-8");
    try {
        checkDocuments(text);
        return YAML::LoadAll(text);
    } catch (const YAML::DeepRecursion& error) {
        throw types::ConfigError({{file, error.mark.line + 1, error.mark.column + 1, "", "is nested too deeply"}});
    } catch (const YAML::Exception& error) {
        throw types::ConfigError({{file, error.mark.line + 1, error.mark.column + 1, "", "is not YAML: " + error.msg}});
    }
}

YAML::Node parseValue(const std::string& text) {
    const auto refuse = [](const std::string& why) { return types::ConfigError("", "", why); };
    try {
        const std::vector<YAML::Node> documents = parseYaml(text, "");
        if (documents.size() > 1) throw refuse("holds several YAML documents; must be one value");
        return documents.empty() ? YAML::Node() : documents[0];
    } catch (const types::ConfigError& error) {
        throw refuse(error.diagnostics().front().message);
    }
}

}  // namespace insonify::framework
