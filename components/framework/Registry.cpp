#include "components/framework/Registry.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <map>
#include <mutex>

namespace insonify::framework {

void Registry::add(Entry entry) {
    const auto same = [&](const Entry& other) { return other.type == entry.type; };
    const auto found = std::find_if(entries_.begin(), entries_.end(), same);
    if (found == entries_.end())
        entries_.push_back(std::move(entry));
    else
        *found = std::move(entry);
}

std::unique_ptr<TaskContext> Registry::make(const std::string& type, const std::string& name) const {
    for (const Entry& entry : entries_)
        if (entry.type == type) return entry.make(name);
    return nullptr;
}

void Registry::loadLibrary(const std::filesystem::path& file) {
    // A path without a slash would be looked for in the system's folders.
    void* library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw types::ConfigError(file.string(), "", std::string("cannot be loaded: ") + dlerror());
    using Register = void (*)(Registry&);
    const auto enter = reinterpret_cast<Register>(dlsym(library, "insonify_register"));
    if (!enter) throw types::ConfigError(file.string(), "", "has no function insonify_register(Registry&)");
    enter(*this);
}

namespace {

/** What was lacking, by the beginnings of names. */
struct Lacking {
    std::mutex mutex;
    std::map<std::string, std::string> all;
};

Lacking& lacking() {
    static Lacking lacking;
    return lacking;
}

}  // namespace

void leaveOut(const std::string& begin, const std::string& package) {
    const std::lock_guard lock(lacking().mutex);
    lacking().all[begin] = package;
}

std::string whyLeftOut(const std::string& type) {
    const std::lock_guard lock(lacking().mutex);
    for (const auto& [begin, package] : lacking().all)
        if (type.starts_with(begin))
            return ", which is left out of this build: it was made without " + package + ", or told to be without it";
    return {};
}

}  // namespace insonify::framework
