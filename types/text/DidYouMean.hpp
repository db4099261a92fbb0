#pragma once
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace insonify::types {

// Letters of names: of ASCII only, and the same in every locale of the process. `std::isalnum` takes bytes above 127
// for letters in a locale of 8 bits, and `std::tolower` keeps I in a Turkish one.

constexpr bool isDigit(char c) { return c >= '0' && c <= '9'; }
constexpr bool isLowerLetter(char c) { return c >= 'a' && c <= 'z'; }
constexpr bool isUpperLetter(char c) { return c >= 'A' && c <= 'Z'; }
constexpr bool isLetter(char c) { return isLowerLetter(c) || isUpperLetter(c); }

constexpr char lowered(char c) { return isUpperLetter(c) ? static_cast<char>(c - 'A' + 'a') : c; }
constexpr char raised(char c) { return isLowerLetter(c) ? static_cast<char>(c - 'a' + 'A') : c; }

inline std::string lowered(std::string text) {
    for (char& c : text) c = lowered(c);
    return text;
}

/** Returns whether a file's text begins with a mark of UTF-16, as some programs on Windows save it. */
constexpr bool isUtf16(std::string_view text) { return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"); }
constexpr const char* utf16_refusal = "is text in UTF-16; save it as UTF-8";

/** Returns a text such as "did you mean range? " for a name that is close to a name in `known`, else empty. A name is
 *  close if at most a third of its letters are missing, added, changed or swapped with a neighbour, ignoring case; a
 * name of three letters or fewer must also begin with the same letter. A part of exactly one known name is close, too.
 * The last part of a known name with a namespace is enough, also without "Task". */
std::string didYouMean(std::string_view wrong, const std::vector<std::string>& known);

/** Returns "is the one of the current folder meant? write /home/me/x.glb; " where a file is not at its place, next to a
 *  deployment for example, and the current folder has one of its name; else "". */
std::string offerCurrentFolder(const std::filesystem::path& missing);

/** Returns the choices as a message lists them: ".a, .b or .c". */
std::string alternatives(const std::vector<std::string_view>& choices);

/** Returns the endings of those formats of a table that are `listed`, as a message lists them. */
template <class Format, size_t count, class Listed = decltype([](const Format&) { return true; })>
std::string alternativeEndings(const Format (&formats)[count], Listed listed = {}) {
    std::vector<std::string_view> endings;
    for (const Format& format : formats)
        if (listed(format)) endings.push_back(format.ending);
    return alternatives(endings);
}

/** Returns the format of a file by its ending in any case of letters; null: the table has none. */
template <class Format, size_t count>
const Format* findFormat(const Format (&formats)[count], const std::filesystem::path& file) {
    const auto* const found = std::ranges::find(formats, lowered(file.extension().string()), &Format::ending);
    return found == std::end(formats) ? nullptr : found;
}

}  // namespace insonify::types
