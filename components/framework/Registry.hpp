#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "components/framework/TaskContext.hpp"
#include "types/ConfigError.hpp"

namespace insonify::loader {
class ComponentLibrary;
}

namespace insonify::framework {

/** The task types that a deployment may name: of the core, and of component libraries, which are loaded when they are
 * named. */
class Registry {
public:
    struct Entry {
        std::string type;  ///< "noise::NoiseTask"
        std::string doc;   ///< One line.
        std::function<std::unique_ptr<TaskContext>(const std::string& name)> make;
    };

    /** A type that is already there is replaced. */
    template <class Task>
    void add(const std::string& type, const std::string& doc) {
        add({type, doc, [](const std::string& name) { return std::make_unique<Task>(name); }});
    }
    void add(Entry entry);
    /** Null when there is no such type. A type that is not there is looked for in the component library of its
     * namespace, if there is one. Throws types::ConfigError where that is absent or cannot be loaded. */
    std::unique_ptr<TaskContext> make(const std::string& type, const std::string& name);
    const std::vector<Entry>& list() const { return entries_; }  ///< In order of registration.

    /** Loads a shared object and calls its `extern "C" void insonify_register(insonify::framework::Registry&)`.
     *  It stays loaded until the process ends. Throws types::ConfigError: not there, not loadable, no such entry. */
    void loadLibrary(const std::filesystem::path& file);
    /** Adds the types of all component libraries that are there. @return what is wrong with those that cannot be loaded
     */
    types::Diagnostics loadAll();

private:
    const Entry* find(const std::string& type) const;
    void enter(const loader::ComponentLibrary& library);

    std::vector<Entry> entries_;
    std::set<std::string> entered_;  ///< Component libraries, by file.
};

}  // namespace insonify::framework
