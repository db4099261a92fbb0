#pragma once
// The project's pages for tests: headings, links, fenced blocks of code.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/Paths.hpp"

namespace insonify::test {

/** A block between two fences: "```sh", the text, "```". */
struct CodeBlock {
    std::string language;  ///< "" if the fence names none.
    size_t line = 0;       ///< Line of the opening fence, from 1.
    std::string text;

    /** Returns whether another block begins below this one, with at most an empty line between them. */
    bool isFollowedBy(const CodeBlock& next) const {
        const auto end = line + 1 + static_cast<size_t>(std::ranges::count(text, '\n'));
        return next.line > end && next.line <= end + 2;
    }
};

/** A page of Markdown. Paths are from the root of the project, with '/' between the parts. */
class Page {
public:
    Page(std::string path, const std::string& text) : path_(std::move(path)) {
        std::istringstream stream(text);
        for (std::string line; std::getline(stream, line);) lines_.push_back(line);
        divide();
    }
    const std::string& path() const { return path_; }
    const std::vector<std::string>& lines() const { return lines_; }
    const std::vector<CodeBlock>& blocks() const { return blocks_; }
    /** Returns the text outside of blocks. */
    const std::string& prose() const { return prose_; }
    /** Returns the texts of the headings of this level, 2 for "## ". */
    std::vector<std::string> headings(size_t level) const {
        std::vector<std::string> found;
        const std::string start = std::string(level, '#') + " ";
        for (const std::string& line : prose_lines_)
            if (line.starts_with(start)) found.push_back(line.substr(start.size()));
        return found;
    }
    /** Returns the anchors that a link may have after '#', as GitHub makes them from headings. */
    std::set<std::string> anchors() const {
        std::set<std::string> found;
        for (size_t level = 1; level <= 6; ++level)
            for (const std::string& heading : headings(level)) {
                const std::string anchor = makeAnchor(heading);
                std::string numbered = anchor;
                for (int n = 1; !found.insert(numbered).second; ++n) numbered = anchor + "-" + std::to_string(n);
            }
        return found;
    }
    /** Returns the targets of links and pictures. */
    std::vector<std::string> links() const {
        static const std::regex link(R"(\]\(([^()\s]*)\))");
        return matches(withoutCode(), link);
    }
    /** Returns the text in back quotes. */
    std::vector<std::string> inlineCode() const {
        static const std::regex quoted("`([^`]+)`");
        std::vector<std::string> found = matches(prose_, quoted);
        for (std::string& code : found) std::ranges::replace(code, '\n', ' ');
        return found;
    }
    /** Returns the addresses on the web, in links and in the text. */
    std::vector<std::string> addresses() const {
        static const std::regex address(R"((https?:[^\s)<>,;]+))");
        return matches(withoutCode(), address);
    }

private:
    static std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
        std::vector<std::string> found;
        for (std::sregex_iterator it(text.begin(), text.end(), pattern); it != std::sregex_iterator(); ++it)
            found.push_back((*it)[1].str());
        return found;
    }
    static std::string makeAnchor(const std::string& heading) {
        std::string anchor;
        for (const unsigned char c : heading)
            if (std::isalnum(c) || c == '_' || c == '-')
                anchor += static_cast<char>(std::tolower(c));
            else if (c == ' ')
                anchor += '-';
        return anchor;
    }
    std::string withoutCode() const {
        static const std::regex quoted("`[^`]*`");
        return std::regex_replace(prose_, quoted, "");
    }
    void divide() {
        bool inside = false;
        for (size_t i = 0; i < lines_.size(); ++i) {
            const size_t indent = std::min(lines_[i].find_first_not_of(' '), lines_[i].size());
            const bool fence = lines_[i].compare(indent, 3, "```") == 0;
            if (fence && !inside) blocks_.push_back({lines_[i].substr(indent + 3), i + 1, ""});
            if (fence)
                inside = !inside;
            else if (inside)
                blocks_.back().text += lines_[i] + "\n";
            else
                prose_lines_.push_back(lines_[i]);
        }
        for (const std::string& line : prose_lines_) prose_ += line + "\n";
    }

    std::string path_, prose_;
    std::vector<std::string> lines_, prose_lines_;
    std::vector<CodeBlock> blocks_;
};

inline Page readPage(const std::string& path) {
    std::ifstream stream(std::filesystem::path(source_dir) / path);
    std::ostringstream text;
    text << stream.rdbuf();
    return {path, text.str()};
}

/** Returns all pages: those in the root folder, and those below its folders. */
inline std::vector<Page> allPages() {
    namespace fs = std::filesystem;
    const fs::path root = source_dir;
    std::set<std::string> paths;
    const auto add = [&](const fs::path& file) {
        if (file.extension() == ".md") paths.insert(fs::relative(file, root).generic_string());
    };
    for (const auto& entry : fs::directory_iterator(root)) add(entry.path());
    for (const char* folder : {"types", "components", "shaders", "deploy", "tests", "scripts", "ros2"})
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) add(entry.path());
    std::vector<Page> pages;
    for (const std::string& path : paths) pages.push_back(readPage(path));
    return pages;
}

/** Returns the text of the page's first block in this language, after a heading if one is named; "" if there is
 *  none. */
inline std::string getCode(const Page& page, const std::string& language, const std::string& heading = "") {
    const auto at = std::ranges::find(page.lines(), "## " + heading);
    const size_t from = heading.empty() ? 0 : static_cast<size_t>(at - page.lines().begin());
    for (const CodeBlock& block : page.blocks())
        if (block.language == language && block.line > from) return block.text;
    return "";
}

/** Returns whether a line is another, in which "..." represents any text. */
inline bool isLike(const std::string& line, const std::string& shown) {
    size_t from = 0, at = 0;
    for (size_t dots; (dots = shown.find("...", at)) != std::string::npos; at = dots + 3) {
        const size_t found = line.find(shown.substr(at, dots - at), from);
        if (found == std::string::npos || (at == 0 && found != 0)) return false;
        from = found + dots - at;
    }
    return at == 0 ? line == shown : line.size() >= from + shown.size() - at && line.ends_with(shown.substr(at));
}

/** Returns the first lines that a page shows, up to the next line of dots alone, and that are not in a row in the
 *  output behind those before them; "" if all are there. */
inline std::string findUnprinted(const std::string& shown, const std::string& output) {
    std::vector<std::string> printed, rows;
    std::istringstream in(output), page(shown + "...\n");
    for (std::string line; std::getline(in, line);) printed.push_back(line);
    auto from = printed.begin();
    for (std::string line; std::getline(page, line);) {
        if (line.find_first_not_of(" .") != std::string::npos || line.find("...") == std::string::npos) {
            rows.push_back(line);
            continue;
        }
        const auto found = std::search(from, printed.end(), rows.begin(), rows.end(), isLike);
        if (found == printed.end() && !rows.empty()) {
            std::string missing;
            for (const std::string& row : rows) missing += row + "\n";
            return missing;
        }
        from = found + static_cast<std::ptrdiff_t>(rows.size());
        rows.clear();
    }
    return "";
}

}  // namespace insonify::test
