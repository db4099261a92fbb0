#include "components/log/pocolog/Metadata.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace insonify::log::pocolog {
namespace {

std::string inQuotes(std::string_view value) {
    std::string text = "\"";
    for (const char c : value) {
        if (c == '"' || c == '\\')
            text += {'\\', c};
        else if (c == '\n')
            text += "\\n";
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            text += fmt::format("\\x{:02x}", c);
        else
            text += c;
    }
    return text + '"';
}

size_t byteOf(const YAML::Mark& mark) { return mark.is_null() ? 0 : static_cast<size_t>(mark.pos); }

}  // namespace

std::string toYaml(const Metadata& metadata) {
    std::string yaml;
    for (const auto& [key, value] : metadata) yaml += key + ": " + inQuotes(value) + "\n";
    return yaml;
}

Metadata metadataFromYaml(std::string_view yaml) try {
    Metadata metadata;
    const YAML::Node map = YAML::Load(std::string(yaml));
    if (!map.IsMap()) return metadata;
    for (const auto& entry : map)
        if (entry.first.IsScalar() && !entry.second.IsMap() && !entry.second.IsSequence())
            metadata[entry.first.Scalar()] = entry.second.Scalar();
    return metadata;
} catch (const YAML::Exception&) {
    return {};
}

std::optional<size_t> findNotFlat(std::string_view yaml) try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(std::string(yaml));
    if (documents.size() > 1) return byteOf(documents[1].Mark());
    if (documents.empty() || documents[0].IsNull()) return {};
    const YAML::Node& map = documents[0];
    if (!map.IsMap()) return byteOf(map.Mark());
    for (const auto& entry : map)
        for (const YAML::Node& node : {YAML::Node(entry.first), YAML::Node(entry.second)})
            if (node.IsMap() || node.IsSequence()) return byteOf(node.Mark());
    return {};
} catch (const YAML::Exception& error) {
    return byteOf(error.mark);
}

}  // namespace insonify::log::pocolog
