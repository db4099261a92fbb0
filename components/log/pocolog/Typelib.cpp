#include "components/log/pocolog/Typelib.hpp"

#include <algorithm>

namespace insonify::log::pocolog {
namespace {

std::string attribute(const char* key, const std::string& value) {
    return std::string(" ") + key + "=\"" + xmlEscaped(value) + "\"";
}

}  // namespace

std::string xmlEscaped(const std::string& name) {
    std::string text;
    for (const char c : name) {
        if (c == '<')
            text += "&lt;";
        else if (c == '>')
            text += "&gt;";
        else
            text += c;
    }
    return text;
}

bool RegistryXml::knows(const std::string& name) const {
    return std::any_of(nodes_.begin(), nodes_.end(), [&](const auto& node) { return node.first == name; });
}

void RegistryXml::addNumeric(const std::string& name, const char* category, size_t size) {
    nodes_.emplace_back(name, "  <numeric" + attribute("name", name) + attribute("category", category) +
                                  attribute("size", std::to_string(size)) + "/>\n");
}

void RegistryXml::addContainerNode(const std::string& name, const char* kind, size_t size, const std::string& element) {
    nodes_.emplace_back(name, "  <container" + attribute("name", name) + attribute("of", element) +
                                  attribute("size", std::to_string(size)) + attribute("kind", kind) + "/>\n");
}

void RegistryXml::addCompound(const std::string& name, size_t size, const std::vector<Member>& members) {
    std::string xml = "  <compound" + attribute("name", name) + attribute("size", std::to_string(size)) + ">\n";
    for (const Member& member : members) {
        xml += "    <field" + attribute("name", member.name) + attribute("type", member.type) +
               attribute("offset", std::to_string(member.offset));
        xml += member.logical_time ? "><metadata key=\"role\"><![CDATA[logical_time]]></metadata></field>\n" : "/>\n";
    }
    nodes_.emplace_back(name, xml + "  </compound>\n");
}

void RegistryXml::addEnum(const std::string& name, std::span<const types::EnumSymbol> symbols) {
    std::string xml = "  <enum" + attribute("name", name) + ">\n";
    for (const types::EnumSymbol& symbol : symbols)
        xml += "    <value" + attribute("symbol", symbol.symbol) + attribute("value", std::to_string(symbol.value)) +
               "/>\n";
    nodes_.emplace_back(name, xml + "  </enum>\n");
}

std::string RegistryXml::text() const {
    std::string xml = "<?xml version=\"1.0\"?>\n<typelib>\n";
    for (const auto& [name, node] : nodes_) xml += node;
    return xml + "</typelib>\n";
}

}  // namespace insonify::log::pocolog
