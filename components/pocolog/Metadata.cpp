#include "components/pocolog/Metadata.hpp"

#include <fmt/format.h>

namespace insonify::pocolog {
namespace {

std::string quoted(std::string_view value) {
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

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r");
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

/** Value of the two hexadecimal digits after an escape `\x`. */
char hexadecimal(std::string_view digits) { return static_cast<char>(std::stoi(std::string(digits), nullptr, 16)); }

std::string withoutEscapes(std::string_view text) {
    std::string value;
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\' || i + 1 == text.size()) {
            value += text[i];
            continue;
        }
        const char escape = text[++i];
        const std::string_view digits = text.substr(i + 1, 2);
        if (escape == 'x' && digits.size() == 2 && digits.find_first_not_of("0123456789abcdefABCDEF") == digits.npos) {
            value += hexadecimal(digits);
            i += 2;
        } else
            value += escape == 'n' ? '\n' : escape == 't' ? '\t' : escape;
    }
    return value;
}

std::string scalar(std::string_view text) {
    text = trimmed(text);
    if (text.size() < 2 || text.front() != text.back()) return std::string(text);
    if (text.front() == '"') return withoutEscapes(text.substr(1, text.size() - 2));
    if (text.front() == '\'') return std::string(text.substr(1, text.size() - 2));
    return std::string(text);
}

/** How the value of the last key may go on over indented lines. */
enum class Open { No, Plain, Quoted, Block };

Open openAfter(std::string_view value) {
    if (value.empty()) return Open::No;
    if (value.front() == '|' || value.front() == '>') return Open::Block;
    if (value.front() != '"' && value.front() != '\'') return Open::Plain;
    return value.size() > 1 && value.back() == value.front() ? Open::No : Open::Quoted;
}

bool goesOn(Open& open, std::string_view text) {
    if (open == Open::Quoted && (text.ends_with('"') || text.ends_with('\''))) {
        open = Open::No;
        return true;
    }
    return open == Open::Quoted || open == Open::Block || (open == Open::Plain && text.find(": ") == text.npos);
}

/** One line; what it leaves open. */
bool isFlat(std::string_view line, Open& open) {
    const std::string_view text = trimmed(line);
    if (text.empty() || line.starts_with('#') || line.starts_with("---") || text == "{}" || text == "...") return true;
    if (line.front() == ' ' || line.front() == '\t') return goesOn(open, text);
    const size_t colon = text.ends_with(':') ? text.size() - 1 : text.find(": ");
    if (colon == text.npos || line.starts_with("- ")) return false;
    const std::string_view value = trimmed(text.substr(colon + 1));
    open = openAfter(value);
    return !value.starts_with('{') && !value.starts_with('[');
}

}  // namespace

std::string toYaml(const Metadata& metadata) {
    std::string yaml;
    for (const auto& [key, value] : metadata) yaml += key + ": " + quoted(value) + "\n";
    return yaml;
}

Metadata metadataFromYaml(std::string_view yaml) {
    Metadata metadata;
    while (!yaml.empty()) {
        const std::string_view line = yaml.substr(0, yaml.find('\n'));
        yaml.remove_prefix(std::min(yaml.size(), line.size() + 1));
        const size_t colon = line.find(": ");
        if (colon != line.npos) metadata[scalar(line.substr(0, colon))] = scalar(line.substr(colon + 1));
    }
    return metadata;
}

std::optional<size_t> findNotFlat(std::string_view yaml) {
    Open open = Open::No;
    for (size_t at = 0; at < yaml.size();) {
        const std::string_view line = yaml.substr(at, yaml.find('\n', at) - at);
        if (!isFlat(line, open)) return at;
        at += line.size() + 1;
    }
    return {};
}

}  // namespace insonify::pocolog
