#include "components/framework/Registry.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/framework/config/DeploymentSpec.hpp"
#include "components/loader/ComponentLibrary.hpp"

namespace insonify::framework {

void Registry::add(Entry entry) {
    const auto same = [&](const Entry& other) { return other.type == entry.type; };
    const auto found = std::find_if(entries_.begin(), entries_.end(), same);
    if (found == entries_.end())
        entries_.push_back(std::move(entry));
    else
        *found = std::move(entry);
}

const Registry::Entry* Registry::find(const std::string& type) const {
    const auto found = std::ranges::find(entries_, type, &Entry::type);
    return found == entries_.end() ? nullptr : &*found;
}

std::unique_ptr<TaskContext> Registry::make(const std::string& type, const std::string& name) {
    if (const Entry* entry = find(type)) return entry->make(name);
    const std::string owner = type.substr(0, type.find(':'));
    if (!loader::findComponent(owner) && !loader::isPresent(owner)) return nullptr;
    enter(loader::load(owner));
    const Entry* entry = find(type);
    return entry ? entry->make(name) : nullptr;
}

void Registry::loadLibrary(const std::filesystem::path& file) {
    const loader::ComponentLibrary& library = loader::loadFile(file);
    if (!library.entry<void(Registry&)>("insonify_register"))
        throw types::ConfigError(file.string(), "", "has no function insonify_register(Registry&)");
    enter(library);
}

types::Diagnostics Registry::loadLibraries(const DeploymentSpec& spec, const std::filesystem::path& folder) {
    ConfigReader reader(spec.file);
    for (size_t i = 0; i < spec.libraries.size(); ++i) try {
            loadLibrary(folder / spec.libraries[i]);
        } catch (const types::ConfigError& error) {
            const bool is_listed = spec.library_list.IsSequence() && i < spec.library_list.size();
            reader.report(is_listed ? spec.library_list[i] : spec.library_list, fmt::format("libraries[{}]", i),
                          "is " + spec.libraries[i] + ": " + error.diagnostics().front().text());
        }
    return reader.diagnostics();
}

types::Diagnostics Registry::loadAll() {
    types::Diagnostics wrong;
    for (const std::string& name : loader::present()) try {
            enter(loader::load(name));
        } catch (const types::ConfigError& error) {
            wrong.insert(wrong.end(), error.diagnostics().begin(), error.diagnostics().end());
        }
    return wrong;
}

/** A library may have other contents than tasks. */
void Registry::enter(const loader::ComponentLibrary& library) {
    if (!entered_.insert(library.file().string()).second) return;
    if (const auto enter = library.entry<void(Registry&)>("insonify_register")) enter(*this);
}

}  // namespace insonify::framework
