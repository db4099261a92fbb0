#pragma once
#include <concepts>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace insonify::types {

/** A sentence for the user about what a task or a file does. What prints it says its kind, too. */
struct Notice {
    enum class Kind : uint8_t { Note, Warning };

    template <std::convertible_to<std::string> Text>
    Notice(Text&& sentence, Kind of_kind = Kind::Note) : text(std::forward<Text>(sentence)), kind(of_kind) {}
    /** Returns the form of logs, of JSON and of the viewer's page: "Warning: " before the text of a warning. */
    explicit operator std::string() const { return kind == Kind::Warning ? "Warning: " + text : text; }
    friend bool operator==(const Notice&, const Notice&) = default;

    std::string text;
    Kind kind;
};
using Notices = std::vector<Notice>;

inline Notice warning(std::string text) { return {std::move(text), Notice::Kind::Warning}; }

/** Returns each notice in the form of logs. */
inline std::vector<std::string> lines(const Notices& notices) {
    std::vector<std::string> lines;
    for (const Notice& notice : notices) lines.emplace_back(notice);
    return lines;
}

}  // namespace insonify::types
