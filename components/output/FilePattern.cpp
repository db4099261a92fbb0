#include "components/output/FilePattern.hpp"

#include <algorithm>

namespace insonify::output {

std::optional<FilePattern> FilePattern::parse(const std::string& pattern) {
    const size_t percent = pattern.find('%');
    if (percent == pattern.npos || pattern.find('%', percent + 1) != pattern.npos) return {};
    const size_t letter = pattern.find_first_not_of("0123456789", percent + 1);
    const std::string flags = pattern.substr(percent + 1, letter - percent - 1);
    if (letter == pattern.npos || pattern[letter] != 'd' || flags.size() > 3 || !pattern.ends_with(".png")) return {};
    FilePattern parsed;
    parsed.before_ = pattern.substr(0, percent);
    parsed.after_ = pattern.substr(letter + 1);
    parsed.width_ = flags.empty() ? 0 : std::stoi(flags);
    parsed.filler_ = flags.starts_with('0') ? '0' : ' ';
    return parsed.width_ > 99 ? std::nullopt : std::optional(parsed);
}

std::string FilePattern::name(uint64_t number) const {
    std::string digits = std::to_string(number);
    digits.insert(0, static_cast<size_t>(std::max(0, width_ - static_cast<int>(digits.size()))), filler_);
    return before_ + digits + after_;
}

}  // namespace insonify::output
