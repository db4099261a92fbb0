#include "components/framework/Registry.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/framework/config/DeploymentSpec.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::framework {

namespace {

/** Returns the reason of the exception that is being handled. Lets types::ConfigError pass. */
std::string reasonUnlessReported() try { throw; } catch (const types::ConfigError&) {
    throw;
} catch (const std::exception& failure) {
    return types::getReason(failure);
} catch (...) {
    return "an exception without a reason";
}

}  // namespace

void Registry::add(Entry entry) {
    const auto isPart = [](char c) { return types::isLetter(c) || types::isDigit(c) || c == '_' || c == ':'; };
    if (entry.type.empty() || !std::ranges::all_of(entry.type, isPart))
        throw types::ConfigError(
            "", "", fmt::format("adds the type \"{}\"; must be a name such as example::MeanEchoTask", entry.type));
    if (const Entry* const same = find(entry.type))
        throw types::ConfigError("", "",
                                 fmt::format("adds the type {}, which {} has; choose another name", entry.type,
                                             same->library.empty()        ? "Insonify"
                                             : same->library == entering_ ? "it"
                                                                          : same->library));
    entry.library = entering_;
    entry.make = [make = std::move(entry.make), type = entry.type](const std::string& name) {
        try {
            return make(name);
        } catch (...) {
            throw types::ConfigError("", type, "has a constructor that throws: " + reasonUnlessReported());
        }
    };
    entries_.push_back(std::move(entry));
}

std::unique_ptr<TaskContext> Registry::example(const Entry& entry) try {
    return entry.make("task");
} catch (const types::ConfigError&) {
    return nullptr;
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
    const std::string file = library.file().string();
    if (entered_.contains(file)) return;
    const size_t before = entries_.size();
    entering_ = file;
    try {
        if (const auto enter = library.entry<void(Registry&)>("insonify_register")) enter(*this);
        entered_.insert(file);
        entering_.clear();
    } catch (...) {
        entries_.resize(before);
        entering_.clear();
        std::string why;
        try {
            why = "has a function insonify_register that throws: " + reasonUnlessReported();
        } catch (const types::ConfigError& error) {
            why = error.diagnostics().empty() ? "has a function insonify_register that throws"
                                              : error.diagnostics().front().text();
        }
        throw types::ConfigError(file, "", why);
    }
}

}  // namespace insonify::framework
