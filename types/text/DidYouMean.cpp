#include "types/text/DidYouMean.hpp"

#include <algorithm>
#include <limits>

namespace insonify::types {
namespace {

std::string lower(std::string_view text) { return lowered(std::string(text)); }

/** Returns the number of letters that are missing, added, changed or swapped with a neighbour (Damerau 1964, restricted
 *  to one edit per place). */
size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<size_t> two(b.size() + 1), one(b.size() + 1), row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) one[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({one[j] + 1, row[j - 1] + 1, one[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], two[j - 2] + 1);
        }
        two.swap(one);
        one.swap(row);
    }
    return one.back();
}

}  // namespace

std::string offerCurrentFolder(const std::filesystem::path& missing) {
    std::error_code none;
    const std::filesystem::path here = std::filesystem::absolute(missing.filename(), none);
    if (!std::filesystem::is_regular_file(here, none)) return "";
    return "is the one of the current folder meant? write " + here.string() + "; ";
}

std::string didYouMean(std::string_view wrong, const std::vector<std::string>& known) {
    constexpr size_t longest = 200;  // longer texts are no mistyped names
    if (wrong.size() > longest) return "";
    const std::string meant = lower(wrong);
    size_t minimum = std::numeric_limits<size_t>::max();
    std::vector<std::string> nearest, holding;
    for (const std::string& name : known) {
        std::string last =
            lower(name).substr(name.rfind(':') + 1);  // SonarTask of sonar::SonarTask; the whole name without ':'
        size_t distance = std::min(editDistance(meant, lower(name)), editDistance(meant, last));
        if (last.ends_with("task") && last != "task") {
            last.erase(last.size() - std::string_view("task").size());
            distance = std::min(distance, editDistance(meant, last));
        }
        if (distance < minimum) nearest = {name};
        minimum = std::min(minimum, distance);
        if (meant.size() >= 3 && lower(name).find(meant) != std::string::npos) holding.push_back(name);
    }
    constexpr size_t short_word = 3;  // one other letter makes another word of it
    const bool other_word = meant.size() <= short_word && !nearest.empty() && !meant.empty() &&
                            lower(nearest.front()).front() != meant.front();
    if (!nearest.empty() && !other_word && minimum <= std::max<size_t>(1, wrong.size() / 3))
        return "did you mean " + nearest.front() + "? ";
    return holding.size() == 1 ? "did you mean " + holding.front() + "? " : "";
}

std::string alternatives(const std::vector<std::string_view>& choices) {
    std::string text;
    for (size_t i = 0; i < choices.size(); ++i)
        text.append(i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ").append(choices[i]);
    return text;
}

}  // namespace insonify::types
