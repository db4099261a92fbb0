#include "components/framework/config/PropertySources.hpp"

#include <fmt/format.h>

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

void PropertySections::read(const std::string& contents, const std::string& shown) try {
    std::istringstream text(contents);
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

namespace {

/** Returns a copy of `block` in which `key` has another value, or is missing if `value` is undefined. Nodes that share
 *  an anchor must not change together. */
YAML::Node with(const YAML::Node& block, const std::string& key, const YAML::Node& value) {
    YAML::Node changed(YAML::NodeType::Map);
    if (block.IsDefined() && block.IsMap())
        for (const auto& entry : block)
            if (!entry.first.IsScalar() || entry.first.Scalar() != key) changed.force_insert(entry.first, entry.second);
    if (value.IsDefined()) changed.force_insert(key, value);
    return changed;
}

/** The same for the value at a dotted path, with the result of `change`. */
YAML::Node changedAt(const YAML::Node& block, const std::string& path, const auto& change) {
    if (path.empty()) return change(block);
    const auto [key, rest] = splitPort(path);
    return with(block, key, changedAt(child(block, key), rest, change));
}

Origin below(const Origin& origin, const YAML::Node& key) {
    return {origin.file, framework::below(origin.path, key.Scalar()), key.Mark()};
}

bool leadsBelow(const std::map<std::string, std::string>& names, const std::string& path) {
    return std::any_of(names.begin(), names.end(),
                       [&](const auto& name) { return name.first.starts_with(path + "."); });
}

/** Whether some values below a block are moved or ignored. */
bool takesApart(const TaskSpec& task, const std::string& path) {
    return leadsBelow(task.aliases, path) || leadsBelow(task.switches, path) ||
           std::ranges::any_of(task.ignored_properties,
                               [&](const std::string& name) { return name.starts_with(path + "."); });
}

std::string fullPath(const TaskSpec& task, const std::string& property) {
    const std::string block = task.path() + ".properties";
    return property.empty() ? block : framework::below(block, property);
}

}  // namespace

void PropertySources::apply() {
    checkTargets();
    std::vector<Moved> moved;
    for (TaskSpec& task : spec_.tasks) {
        const Origin here{spec_.file, fullPath(task, "")};
        task.properties.reset(withoutAliases(task, task.properties, "", here, moved));
    }
    move(moved);
    for (TaskSpec& task : spec_.tasks) applyFiles(task);
    for (const auto& [target, change] : switches_) turn(target, change.first, change.second);
}

void PropertySources::checkTargets() {
    ConfigReader reader(spec_.file);
    for (const TaskSpec& task : spec_.tasks)
        for (const auto& [key, names] : {std::pair("aliases", &task.aliases), std::pair("copies", &task.copies),
                                         std::pair("switches", &task.switches)})
            for (const auto& [name, target] : *names) {
                const auto [owner, rest] = splitPort(target);
                const YAML::Node place = child(child(task.place, key), name);
                const std::string path = task.path() + "." + key + "." + name;
                if (rest.empty())
                    reader.report(place, path, "is " + target + "; must be task.property or task.port");
                else if (!spec_.task(owner))
                    reader.report(place, path,
                                  "there is no task " + owner + "; " + suggestion(owner, spec_.taskNames()));
            }
    spec_.diagnostics.insert(spec_.diagnostics.end(), reader.diagnostics().begin(), reader.diagnostics().end());
}

YAML::Node PropertySources::withoutAliases(TaskSpec& task, const YAML::Node& block, const std::string& path,
                                           const Origin& origin, std::vector<Moved>& moved) {
    const bool has_none =
        task.aliases.empty() && task.copies.empty() && task.switches.empty() && task.ignored_properties.empty();
    if (has_none || !block.IsDefined() || !block.IsMap()) return block;
    YAML::Node rest(YAML::NodeType::Map);
    for (const auto& entry : block) {
        const std::string name = entry.first.IsScalar() ? framework::below(path, entry.first.Scalar()) : "";
        if (const auto copy = task.copies.find(name); copy != task.copies.end())
            moved.push_back({copy->second, entry.second, below(origin, entry.first), false});
        if (const auto alias = task.aliases.find(name); alias != task.aliases.end()) {
            moved.push_back({alias->second, entry.second, below(origin, entry.first), false});
        } else if (const auto change = task.switches.find(name); change != task.switches.end()) {
            moved.push_back({change->second, entry.second, below(origin, entry.first), true});
        } else if (task.ignores(name)) {
            task.omitted.insert(name);
        } else if (takesApart(task, name)) {
            const YAML::Node inner = withoutAliases(task, entry.second, name, below(origin, entry.first), moved);
            if (!inner.IsMap() || inner.size() > 0) rest.force_insert(entry.first, inner);
        } else {
            rest.force_insert(entry.first, entry.second);
        }
    }
    return rest;
}

void PropertySources::move(const std::vector<Moved>& moved) {
    for (const Moved& one : moved) {
        const auto [owner, property] = splitPort(one.target);
        bool on = false;
        ConfigReader reader(one.origin.file);
        if (!one.is_switch) {
            if (TaskSpec* task = spec_.task(owner)) lay(*task, property, one.value, one.origin);
        } else if (reader.readValue(one.value, one.origin.path, types::Field{""}, on)) {
            switches_[one.target] = {on, one.origin};
        }
        spec_.diagnostics.insert(spec_.diagnostics.end(), reader.diagnostics().begin(), reader.diagnostics().end());
    }
}

void PropertySources::applyFiles(TaskSpec& task) {
    if (task.property_files.files.empty()) return;
    PropertySections sections;
    const auto folder = std::filesystem::path(spec_.file).parent_path();
    const std::vector<std::string>& files = task.property_files.files;
    ConfigReader here(spec_.file);
    const YAML::Node place = child(task.place, "property_files"), list = child(place, "files");
    for (size_t i = 0; i < files.size(); ++i) try {
            sections.read(readFile(folder / files[i], "a property file"), (folder / files[i]).string());
        } catch (const types::ConfigError& error) {
            here.report(list.IsSequence() && i < list.size() ? list[i] : place,
                        fmt::format("{}.property_files.files[{}]", task.path(), i),
                        "is " + files[i] + ", which " + error.diagnostics().front().message);
        }
    const bool has_none = !here.diagnostics().empty() && sections.names().empty();
    for (const std::string& name : task.property_files.sections)
        if (!has_none && !sections.contains(name))
            here.report(place, task.path() + ".property_files.sections",
                        "there is no section " + name + "; " + suggestion(name, sections.names()));
    types::Diagnostics diagnostics = here.diagnostics();
    for (const PropertySection* section : sections.inOrder(task.property_files.sections)) {
        ConfigReader reader(section->file);
        std::vector<Moved> moved;
        const Origin there{section->file, ""};
        const YAML::Node rest = withoutAliases(task, section->body, "", there, moved);
        if (reader.isMap(section->body, section->name) && rest.IsMap())
            for (const auto& entry : rest) lay(task, entry.first.Scalar(), entry.second, below(there, entry.first));
        diagnostics.insert(diagnostics.end(), reader.diagnostics().begin(), reader.diagnostics().end());
        move(moved);
    }
    diagnostics.insert(diagnostics.end(), sections.diagnostics().begin(), sections.diagnostics().end());
    spec_.diagnostics.insert(spec_.diagnostics.end(), diagnostics.begin(), diagnostics.end());
}

void PropertySources::lay(TaskSpec& task, const std::string& path, const YAML::Node& over, const Origin& origin) {
    task.properties.reset(changedAt(
        task.properties, path, [&](const YAML::Node& base) { return laid(base, over, fullPath(task, path), origin); }));
}

YAML::Node PropertySources::laid(const YAML::Node& base, const YAML::Node& over, const std::string& path,
                                 const Origin& origin) {
    if (base.IsDefined() && base.IsMap() && over.IsMap()) {
        YAML::Node merged = base;
        for (const auto& entry : over) {
            const std::string& key = entry.first.Scalar();
            const YAML::Node value =
                laid(child(merged, key), entry.second, framework::below(path, key), below(origin, entry.first));
            merged.reset(with(merged, key, value));
        }
        return merged;
    }
    if (base.IsDefined() && base.IsSequence() && over.IsSequence()) {
        YAML::Node merged(YAML::NodeType::Sequence);
        for (size_t i = 0; i < std::max(base.size(), over.size()); ++i) {
            const std::string index = "[" + std::to_string(i) + "]";
            const Origin element{origin.file, origin.path + index, origin.mark};
            if (i >= over.size())
                merged.push_back(base[i]);
            else
                merged.push_back(laid(i < base.size() ? base[i] : YAML::Node(YAML::NodeType::Undefined), over[i],
                                      path + index, element));
        }
        return merged;
    }
    spec_.origins[path] = origin;
    return over;
}

void PropertySources::turn(const std::string& target, bool on, const Origin& origin) {
    const auto [owner, property] = splitPort(target);
    TaskSpec* const task = spec_.task(owner);
    if (!task) return;
    task->properties.reset(changedAt(task->properties, property, [&](const YAML::Node& block) {
        if (!on) return YAML::Node(YAML::NodeType::Undefined);
        if (block.IsDefined()) return block;
        return laid(block, YAML::Node(YAML::NodeType::Map), fullPath(*task, property), origin);
    }));
}

YAML::Node PropertySources::set(const YAML::Node& base, const YAML::Node& over, const std::string& path,
                                const Origin& origin) {
    const bool merges = over.IsMap() && base.IsDefined() && base.IsMap();
    if (!merges) spec_.origins[path] = origin;
    if (over.IsNull()) return YAML::Node(YAML::NodeType::Undefined);
    if (!over.IsMap()) return over;
    YAML::Node merged = merges ? base : YAML::Node(YAML::NodeType::Map);
    for (const auto& entry : over) {
        const std::string& key = entry.first.Scalar();
        const YAML::Node value = set(child(merged, key), entry.second, framework::below(path, key),
                                     {origin.file, framework::below(origin.path, key), origin.mark});
        merged.reset(with(merged, key, value));
    }
    return merged;
}

void PropertySources::set(TaskSpec& task, const std::string& property, const YAML::Node& value, const Origin& from) {
    const auto replace = [&](TaskSpec& owner, const std::string& path, const YAML::Node& by, const Origin& origin) {
        owner.properties.reset(changedAt(owner.properties, path, [&](const YAML::Node& base) {
            return set(base, by, fullPath(owner, path), origin);
        }));
    };
    if (task.ignores(property))
        throw types::ConfigError("", "", "is one of the task's ignored_properties, which are not used");
    const bool has_place = from.file != set_origin;
    const Origin origin{from.file, has_place ? "" : fullPath(task, ""), from.mark};
    const YAML::Node block = changedAt(YAML::Node(), property, [&](const YAML::Node&) { return value; });
    std::vector<Moved> moved;
    const YAML::Node rest = withoutAliases(task, block, "", origin, moved);
    if (moved.empty())
        return replace(task, property, value, has_place ? from : Origin{set_origin, fullPath(task, property)});
    for (const auto& entry : rest) lay(task, entry.first.Scalar(), entry.second, below(origin, entry.first));
    for (const Moved& one : moved) {
        const auto [owner, path] = splitPort(one.target);
        if (one.is_switch)
            move({one});
        else if (TaskSpec* target = spec_.task(owner))
            replace(*target, path, one.value, one.origin);
    }
    for (const auto& [target, change] : switches_) turn(target, change.first, change.second);
}

}  // namespace insonify::framework
