#include "components/framework/config/YamlText.hpp"

#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>

#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::framework {

std::string readFile(const std::filesystem::path& file, const std::string& what) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error))
        throw types::ConfigError(file.string(), "", "is a directory; must be " + what);
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw types::ConfigError(file.string(), "",
                                 fmt::format("cannot be opened{}; must be {}", types::permissionReason(errno), what));
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

namespace {

std::vector<std::string> getLines(const std::string& text) {
    std::vector<std::string> lines;
    std::string line;
    for (std::istringstream stream(text); std::getline(stream, line);) lines.push_back(line);
    return lines;
}

size_t getIndent(const std::string& line) { return std::min(line.find_first_not_of(' '), line.size()); }

bool isBlank(const std::string& line) {
    const size_t first = line.find_first_not_of(" \t\r");
    return first == std::string::npos || line[first] == '#';
}

bool isIndentedByTab(const std::string& line) {
    const size_t tab = line.find('\t');
    return !isBlank(line) && tab != std::string::npos && tab < line.find_first_not_of(" \t");
}

/** Returns the indents that a line may have, smallest first: the starts of the lines above whose blocks are still
 *  open. */
std::vector<size_t> openIndents(const std::vector<std::string>& lines, size_t line) {
    std::vector<size_t> indents;
    for (size_t i = line; i-- > 0;)
        if (!isBlank(lines[i]) && (indents.empty() || getIndent(lines[i]) < indents.front()))
            indents.insert(indents.begin(), getIndent(lines[i]));
    return indents;
}

/** Whether the line above ends like a key with a block below it. */
bool opensBlock(const std::vector<std::string>& lines, size_t line) {
    while (line-- > 0)
        if (!isBlank(lines[line])) return lines[line].find_last_not_of(" \t\r") == lines[line].rfind(':');
    return false;
}

/** Returns what is wrong with a line's indent, which YAML's own message does not say; empty: nothing. */
std::string indentDiagnostic(const std::vector<std::string>& lines, size_t line) {
    if (line >= lines.size() || isBlank(lines[line])) return "";
    if (isIndentedByTab(lines[line])) return "is indented with a tab; indent with spaces";
    const std::vector<size_t> open = openIndents(lines, line);
    const size_t indent = getIndent(lines[line]);
    if (open.empty() || std::ranges::count(open, indent) > 0) return "";
    if (indent > open.back() && opensBlock(lines, line)) return "";
    std::string may_be;
    for (const size_t each : open) may_be += (may_be.empty() ? "" : " or ") + std::to_string(each);
    return "is indented by " + std::to_string(indent) + " spaces; after the lines above, it may be by " + may_be;
}

/** Returns yaml-cpp's message, reworded where it says little. */
std::string yamlDiagnostic(const std::string& text, const YAML::Exception& error) {
    if (error.msg.find("map flow") != std::string::npos) return "is not YAML: a { has no } to close it";
    if (error.msg.find("sequence flow") != std::string::npos) return "is not YAML: a [ has no ] to close it";
    const std::string indent =
        error.mark.line < 0 ? "" : indentDiagnostic(getLines(text), static_cast<size_t>(error.mark.line));
    if (!indent.empty()) return indent;
    if (error.msg == "illegal map value")
        return "is not YAML: has a colon where no key can be; put a text with \": \" in quotes";
    return "is not YAML: " + error.msg;
}

class Progress final : public YAML::EventHandler {
public:
    void OnDocumentStart(const YAML::Mark& mark) override {
        if (mark.pos == last_) throw YAML::ParserException(mark, "this cannot begin a value");
        last_ = mark.pos;
    }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
    void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
    void OnScalar(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  const std::string& /*value*/) override {}
    void OnSequenceStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                         YAML::EmitterStyle::value /*style*/) override {}
    void OnSequenceEnd() override {}
    void OnMapStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                    YAML::EmitterStyle::value /*style*/) override {}
    void OnMapEnd() override {}

private:
    int last_ = -1;
};

/** Throws YAML::Exception where yaml-cpp would find endless documents: at a character that cannot begin a value, such
 *  as a comma, it makes an empty document and does not advance. */
void checkDocuments(const std::string& text) {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    Progress progress;
    while (parser.HandleNextDocument(progress)) {
    }
}

}  // namespace

std::vector<YAML::Node> parseYaml(const std::string& text, const std::string& file) {
    if (!isText(text)) throw types::ConfigError(file, "", "is not text; must be YAML in UTF-8");
    try {
        checkDocuments(text);
        return YAML::LoadAll(text);
    } catch (const YAML::DeepRecursion& error) {
        throw types::ConfigError({{"", "is nested too deeply", file, error.mark.line + 1, error.mark.column + 1}});
    } catch (const YAML::Exception& error) {
        throw types::ConfigError({{"", yamlDiagnostic(text, error), file, error.mark.line + 1, error.mark.column + 1}});
    }
}

YAML::Node parseValue(const std::string& text) {
    const auto refuse = [](const std::string& why) { return types::ConfigError("", "", why); };
    try {
        const std::vector<YAML::Node> documents = parseYaml(text, "");
        if (documents.size() > 1) throw refuse("holds several YAML documents; must be one value");
        const YAML::Node node = documents.empty() ? YAML::Node() : documents[0];
        if (node.IsNull() && !text.empty() && text != "~" && types::lowered(text) != "null")
            throw refuse("is `" + text +
                         "`, which YAML takes for nothing; put a text that begins with # or % in quotes");
        return node;
    } catch (const types::ConfigError& error) {
        throw refuse(error.diagnostics().front().message);
    }
}

}  // namespace insonify::framework
