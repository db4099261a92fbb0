#include "components/dataset/Classes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "components/dataset/Samples.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::dataset {

std::string withoutNumber(const std::string& name) {
    const size_t letter = name.find_last_not_of("0123456789");
    if (letter == std::string::npos || letter + 1 == name.size()) return name;
    const size_t end = name.find_last_not_of("_-. ", letter);
    return end == std::string::npos ? name : name.substr(0, end + 1);
}

Classes::Classes(const Sweep& sweep, const std::vector<std::string>& objects, const std::vector<std::string>& nodes)
    : rules_(sweep.classes) {
    std::vector<std::string> known = objects;
    known.insert(known.end(), nodes.begin(), nodes.end());
    types::Diagnostics unmatched;
    size_t patterns = 0;
    for (const ClassRule& rule : rules_) {
        std::ranges::move(findUnmatched(sweep, rule.patterns, known, "classes." + rule.name, rule.line, rule.column,
                                        sweep.scenes.size() > 1 ? "any of the scenes" : "the scene"),
                          std::back_inserter(unmatched));
        patterns += rule.patterns.size();
        names_.push_back(rule.name);
    }
    if (patterns > 0 && unmatched.size() == patterns) throw types::ConfigError(unmatched);
    for (const types::Diagnostic& each : unmatched) notices_.push_back(each.text());
    noteLost(known);
    std::set<std::string> bare;
    for (const std::string& object : objects) bare.insert(withoutNumber(object));
    if (rules_.empty()) names_.assign(bare.begin(), bare.end());
    if (sweep.annotations.shadows) {
        first_shadow_ = static_cast<uint32_t>(names_.size());
        for (uint32_t i = 0; i < first_shadow_; ++i) names_.push_back(names_[i] + "_shadow");
    }
    if (sweep.annotations.ghosts) {
        names_.emplace_back("ghost");
        ghost_ = static_cast<uint32_t>(names_.size());
    }
    refuseTwice(sweep);
}

void Classes::noteLost(const std::vector<std::string>& names) {
    for (size_t rule = 1; rule < rules_.size(); ++rule) {
        std::string lost;
        bool keeps = false;
        for (const std::string& name : names) {
            if (std::ranges::none_of(rules_[rule].patterns,
                                     [&](const std::string& each) { return matches(each, name); }))
                continue;
            if (of(name) == rule + 1)
                keeps = true;
            else if (lost.empty())
                lost = fmt::format("{} is a {}", name, rules_[of(name) - 1].name);
        }
        if (!keeps && !lost.empty())
            notices_.push_back(fmt::format("classes.{}: all its names match a class before it, which counts: {}",
                                           rules_[rule].name, lost));
    }
}

void Classes::refuseTwice(const Sweep& sweep) const {
    std::set<std::string> known;
    for (const std::string& name : names_)
        if (!known.insert(name).second)
            throw types::ConfigError(sweep.file, "classes",
                                     "has " + name + ", which is the class of shadows or ghosts; name it otherwise");
}

uint32_t Classes::of(const std::string& object) const {
    for (size_t i = 0; i < rules_.size(); ++i)
        if (std::ranges::any_of(rules_[i].patterns, [&](const std::string& each) { return matches(each, object); }))
            return static_cast<uint32_t>(i + 1);
    if (!rules_.empty()) return 0;
    const auto found = std::ranges::find(names_, withoutNumber(object));
    return found == names_.end() ? 0 : static_cast<uint32_t>(found - names_.begin() + 1);
}

}  // namespace insonify::dataset
