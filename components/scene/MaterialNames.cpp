#include "components/scene/MaterialNames.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "types/Ascii.hpp"

namespace insonify::scene {
namespace {

/** A synonym of a matter or a sediment. */
struct Synonym {
    std::string_view word, name;
};
constexpr Synonym synonyms[] = {
    {"aluminum", "aluminium"},
    {"alu", "aluminium"},
    {"metal", "steel"},
    {"stainless_steel", "steel"},
    {"iron", "cast_iron"},
    {"brass", "bronze"},
    {"rusty_steel", "carbon_steel"},
    {"rusted_steel", "carbon_steel"},
    {"corroded_steel", "carbon_steel"},
    {"stone", "rock"},
    {"boulder", "rock"},
    {"cement", "concrete"},
    {"plexiglass", "acrylic"},
    {"plexiglas", "acrylic"},
    {"perspex", "acrylic"},
    {"polyethylene", "hdpe"},
    {"fiberglass", "fibreglass"},
    {"grp", "fibreglass"},
    {"gfk", "fibreglass"},
    {"wooden", "wood"},
    {"timber", "wood"},
    {"netting", "net"},
    {"fishing_net", "net"},
    {"biofouling", "fouling"},
    {"barnacles", "fouling"},
    {"marine_growth", "fouling"},
    {"human", "human_body"},
    {"person", "human_body"},
    {"swimmer", "human_body"},
    {"sand", "medium_sand"},
    {"gravel", "sandy_gravel"},
    {"mud", "clay"},
    {"silt", "medium_silt"},
};

/** Returns the matter or else the sediment of that name: "rock" is matter, "sand" is the sediment. */
std::string_view nameOf(std::string_view words) {
    const auto* synonym = std::ranges::find(synonyms, words, &Synonym::word);
    if (synonym != std::end(synonyms)) return synonym->name;
    if (const auto matter = acoustics::matterNamed(words)) return acoustics::nameOf(*matter);
    const auto& sediments = types::EnumNames<Sediment>::names;
    const auto* sediment = std::ranges::find(sediments, words);
    return sediment != std::end(sediments) && words != "mackenzie" ? *sediment : std::string_view();
}

Acoustics acousticsOf(std::string_view name) {
    Acoustics acoustics;
    acoustics.material = acoustics::matterNamed(name);
    const auto& sediments = types::EnumNames<Sediment>::names;
    if (!acoustics.material)
        acoustics.sediment = static_cast<Sediment>(std::ranges::find(sediments, name) - std::begin(sediments));
    return acoustics;
}

/** Joins texts up to a max number, because a notice is one line. */
std::string listed(const std::vector<std::string>& texts) {
    constexpr size_t max_shown = 20;
    const size_t shown = std::min(texts.size(), max_shown);
    const auto last = texts.begin() + static_cast<std::ptrdiff_t>(shown);
    return fmt::format("{}{}", fmt::join(texts.begin(), last, ", "),
                       shown < texts.size() ? fmt::format(" and {} more", texts.size() - shown) : "");
}

std::string noticeOf(const std::vector<std::string>& taken, const std::vector<std::string>& unclear) {
    std::string text;
    if (!taken.empty()) text = "materials without acoustic values are taken by their names: " + listed(taken);
    if (!unclear.empty())
        text +=
            (text.empty() ? "" : "; ") + ("materials whose names contain several stay medium sand: " + listed(unclear));
    return text + "; `materials` of the scene's task gives others, `materials_by_name: false` takes none";
}

}  // namespace

std::vector<std::string> wordsOf(const std::string& name) {
    std::vector<std::string> words(1);
    for (size_t i = 0; i < name.size(); ++i) {
        const bool begins = i > 0 && types::isUpperLetter(name[i]) && types::isLowerLetter(name[i - 1]);
        if ((begins || !types::isLetter(name[i])) && !words.back().empty()) words.emplace_back();
        if (types::isLetter(name[i])) words.back() += types::lowered(name[i]);
    }
    return words;
}

std::vector<std::string_view> matterIn(const std::string& name) {
    constexpr size_t max_words = 3;
    const std::vector<std::string> words = wordsOf(name);
    std::vector<std::string_view> found;
    for (size_t i = 0; i < words.size();) {
        size_t taken = 1;
        for (size_t count = std::min(max_words, words.size() - i); count > 0; --count) {
            const auto first = words.begin() + static_cast<std::ptrdiff_t>(i);
            const std::string joined =
                fmt::format("{}", fmt::join(first, first + static_cast<std::ptrdiff_t>(count), "_"));
            const std::string_view matter = nameOf(joined);
            if (matter.empty()) continue;
            if (std::ranges::find(found, matter) == found.end()) found.push_back(matter);
            taken = count;
            break;
        }
        i += taken;
    }
    return found;
}

types::GeometryPtr takeNames(const types::GeometryPtr& geometry) {
    std::vector<std::string> taken, unclear;
    std::shared_ptr<types::Geometry> named;
    for (size_t i = 0; i < geometry->materials.size(); ++i) {
        const std::string name = geometry->materials[i].name;
        if (geometry->materials[i].has_acoustics) continue;
        const std::vector<std::string_view> found = matterIn(name);
        if (found.empty()) continue;
        std::string text = fmt::format("\"{}\" as {}", name, fmt::join(found, " or "));
        std::vector<std::string>& list = found.size() == 1 ? taken : unclear;
        if (std::ranges::find(list, text) == list.end()) list.push_back(std::move(text));
        if (!named) named = std::make_shared<types::Geometry>(*geometry);
        if (found.size() > 1) continue;
        acousticsOf(found.front()).applyTo(named->materials[i]);
        named->materials[i].is_named = true;
    }
    if (!named) return geometry;
    named->notices.push_back(noticeOf(taken, unclear));
    return named;
}

}  // namespace insonify::scene
