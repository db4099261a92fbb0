#include "components/sonars/Sonars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/Embed.hpp"
#include "components/framework/config/YamlText.hpp"
#include "types/text/DidYouMean.hpp"

INSONIFY_EMBED(insonify_sonars, INSONIFY_SONARS)

namespace insonify::sonars {
namespace {

/** Adds the keys of figures that are given. */
template <types::Described Figures>
void addGiven(const Figures& figures, std::set<std::string>& keys) {
    auto visit = [&]<class T>(const types::Field& field, const T& value) {
        if (value != T{}) keys.insert(field.name);
    };
    Figures::describe(figures, visit);
}

bool isDay(const std::string& text) {
    if (text.size() != 10) return false;
    for (size_t i = 0; i < text.size(); ++i)
        if (i == 4 || i == 7 ? text[i] != '-' : !types::isDigit(text[i])) return false;
    return true;
}

}  // namespace

void SonarDevice::check(types::Diagnostics& diagnostics) const {
    if (kind != "lens" && kind != "array" && kind != "head")
        diagnostics.push_back({"kind", "is '" + kind + "'; must be lens, array or head"});
    if (kind != "array" && (gain_error_db != 0 || phase_error_deg != 0))
        diagnostics.push_back({"gain_error_db", "and phase_error_deg are errors of elements, which only an array has"});
    if (kind != "head" && step_error_deg != 0)
        diagnostics.push_back({"step_error_deg", "is given, but only a head has steps"});
    if ((code_bits > 0) != ((gamma > 0) != (dynamic_range_db > 0)))
        diagnostics.push_back({"code_bits", "needs one of gamma and dynamic_range_db, the law of the codes"});
}

void SonarFigures::check(types::Diagnostics& diagnostics) const {
    if (modes.empty()) diagnostics.push_back({"modes", "is empty; a sonar has at least one"});
    std::set<std::string> figures;
    if (part != 0) figures.insert("part");
    for (size_t i = 0; i < modes.size(); ++i) {
        addGiven(modes[i], figures);
        if (modes[i].frequency_khz == 0 || modes[i].range_min >= modes[i].range_max)
            diagnostics.push_back(
                {fmt::format("modes[{}]", i), "must have frequency_khz, and range_min below range_max"});
    }
    if (device) addGiven(*device, figures);
    if (starter && !device) diagnostics.push_back({"device", "is absent; a sonar with a starter has one"});
    std::set<std::string> given;
    for (size_t i = 0; i < sources.size(); ++i) {
        const std::string path = fmt::format("sources[{}]", i);
        if (sources[i].document.empty()) diagnostics.push_back({path, "has no document"});
        if (!isDay(sources[i].read))
            diagnostics.push_back({path + ".read", "is '" + sources[i].read + "'; must be a day, as in 2026-11-22"});
        for (const std::string& key : sources[i].gives) {
            if (!figures.contains(key))
                diagnostics.push_back({path + ".gives", "names " + key + ", which is not given"});
            if (!given.insert(key).second) diagnostics.push_back({path + ".gives", "names " + key + " again"});
        }
    }
    for (const std::string& key : figures)
        if (!given.contains(key)) diagnostics.push_back({"sources", "give no source of " + key});
}

std::vector<SonarFigures> readSonars(const std::string& yaml, const std::string& file) {
    std::vector<SonarFigures> all;
    framework::ConfigReader reader(file);
    for (const YAML::Node& document : framework::parseYaml(yaml, file))
        if (reader.isMap(document, ""))
            for (const auto& entry : document) {
                SonarFigures& sonar = all.emplace_back();
                sonar.name = entry.first.Scalar();
                reader.read(entry.second, sonar.name, sonar);
            }
    if (!reader.diagnostics().empty()) throw types::ConfigError(reader.diagnostics());
    return all;
}

const std::vector<SonarFigures>& sonars() {
    static const std::vector<SonarFigures> all =
        readSonars(std::string(framework::embedded(insonify_sonars_begin, insonify_sonars_end)), "sonars.yml");
    return all;
}

const SonarFigures& sonar(const std::string& name) {
    const auto found = std::ranges::find(sonars(), name, &SonarFigures::name);
    if (found == sonars().end()) throw std::out_of_range("there is no sonar " + name);
    return *found;
}

}  // namespace insonify::sonars
