#include "components/framework/config/PropertySections.hpp"

#include <algorithm>
#include <sstream>

#include "components/framework/config/ConfigReader.hpp"
#include "components/framework/config/YamlText.hpp"

namespace insonify::framework {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, at);)
        if (!part.empty()) parts.push_back(part);
    return parts;
}

}  // namespace

void PropertySections::report(const std::string& file, int line, const std::string& path, const std::string& message) {
    diagnostics_.push_back({path, message, file, line, line > 0 ? 1 : 0});
}

void PropertySections::read(const std::filesystem::path& file, const std::string& shown) try {
    std::istringstream text(readFile(file, "a property file"));
    PropertySection section{"default", shown, 0, true, {}, {}};
    std::string body, line;
    for (int number = 1; std::getline(text, line); ++number) {
        if (line.find("<%") != std::string::npos)
            report(shown, number, "", "holds Ruby, which is not run; write the value");
        if (!line.starts_with("---")) {
            body += line + "\n";
            continue;
        }
        take(std::move(section), body);
        section = header(line, shown, number);
        body.assign(static_cast<size_t>(number), '\n');  // keeps the section's line numbers those of the file
    }
    take(std::move(section), body);
} catch (const types::ConfigError& error) {
    for (const types::Diagnostic& diagnostic : error.diagnostics()) report(shown, 0, "", diagnostic.message);
}

PropertySection PropertySections::header(const std::string& line, const std::string& file, int number) {
    PropertySection section{"", file, number, true, {}, {}};
    std::istringstream words(line.substr(0, line.find('#')).substr(3));
    for (std::string word; words >> word;) {
        const size_t colon = word.find(':');
        const std::string key = word.substr(0, colon);
        const std::string value = colon == std::string::npos ? "" : word.substr(colon + 1);
        if (key == "name" && !value.empty())
            section.name = value;
        else if (key == "merge" && (value == "true" || value == "false"))
            section.merge = value == "true";
        else if (key == "chain" && !value.empty())
            section.chain = split(value, ',');
        else
            report(file, number, "", "has " + word + " in the head of a section; may be name:x, merge:true, chain:a,b");
    }
    if (section.name.empty() && number == 1) section.name = "default";
    if (section.name.empty()) report(file, number, "", "starts a section without a name; must be --- name:x");
    return section;
}

void PropertySections::take(PropertySection section, const std::string& body) {
    try {
        const std::vector<YAML::Node> documents = parseYaml(body, section.file);
        if (section.line == 0 && (documents.empty() || documents.front().IsNull())) return;  // before the first header
        if (documents.size() > 1) report(section.file, section.line, section.name, "holds several YAML documents");
        if (!documents.empty()) section.body.reset(documents.front());
    } catch (const types::ConfigError& error) {
        diagnostics_.insert(diagnostics_.end(), error.diagnostics().begin(), error.diagnostics().end());
        return;
    }
    std::vector<PropertySection>& same = sections_[section.name];
    const auto twice = [&](const PropertySection& other) { return other.file == section.file; };
    if (std::any_of(same.begin(), same.end(), twice))
        report(section.file, section.line, section.name, "is a section that is given twice; once is allowed");
    if (!section.merge) same.clear();
    same.push_back(std::move(section));
}

std::vector<std::string> PropertySections::names() const {
    std::vector<std::string> names;
    for (const auto& [name, sections] : sections_) names.push_back(name);
    return names;
}

std::vector<const PropertySection*> PropertySections::inOrder(const std::vector<std::string>& names) {
    std::vector<const PropertySection*> all;
    std::vector<std::string> open;
    for (const std::string& name : names) addChained(name, open, all);
    return all;
}

void PropertySections::addChained(const std::string& name, std::vector<std::string>& open,
                                  std::vector<const PropertySection*>& all) {
    const auto found = sections_.find(name);
    if (found == sections_.end()) return;  // reported by the caller that names it
    open.push_back(name);
    for (const PropertySection& section : found->second) {
        for (const std::string& base : section.chain) {
            if (std::find(open.begin(), open.end(), base) != open.end())
                report(section.file, section.line, name, "chains " + base + ", which chains it");
            else if (!contains(base))
                report(section.file, section.line, name, "chains " + base + "; " + suggestion(base, this->names()));
            else
                addChained(base, open, all);
        }
        all.push_back(&section);
    }
    open.pop_back();
}

}  // namespace insonify::framework
