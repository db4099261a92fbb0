#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "components/framework/TaskContext.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::loader {
class ComponentLibrary;
}

namespace insonify::framework {

struct DeploymentSpec;

/** The task types that a deployment may name: those of the core and of component libraries. A component library is
 *  loaded when a deployment names one of its types. */
class Registry {
public:
    struct Entry {
        std::string type;  ///< "noise::NoiseTask"
        std::string doc;   ///< One line.
        /** Makes a task. Throws types::ConfigError, as does a constructor that throws anything else. */
        std::function<std::unique_ptr<TaskContext>(const std::string& name)> make;
        std::string library{};  ///< File of the component library; empty: the core.
    };

    /** Adds a type. Throws types::ConfigError for a name that is no word, or one that is there already. */
    template <class Task>
    void add(const std::string& type, const std::string& doc) {
        add({type, doc, [](const std::string& name) { return std::make_unique<Task>(name); }});
    }
    void add(Entry entry);
    /** Makes a task; null when there is no such type. An unknown type is searched in the component library of its
     *  namespace, if the namespace has one. Throws types::ConfigError when that library is missing or cannot be
     *  loaded. */
    std::unique_ptr<TaskContext> make(const std::string& type, const std::string& name);
    const std::vector<Entry>& list() const { return entries_; }  ///< In order of registration.
    const Entry* find(const std::string& type) const;            ///< Of the list; null: it has no such type.
    /** Makes a task to look at; null where its constructor throws. */
    static std::unique_ptr<TaskContext> example(const Entry& entry);

    /** Loads a shared object and calls its `extern "C" void insonify_register(insonify::framework::Registry&)`. It
     *  stays loaded until the process ends. Throws types::ConfigError when the file is missing, cannot be loaded, or
     *  lacks that function. */
    void loadLibrary(const std::filesystem::path& file);
    /** Loads the `libraries` of a deployment in `folder`. @return diagnostics, each at its place in the file */
    types::Diagnostics loadLibraries(const DeploymentSpec& spec, const std::filesystem::path& folder);
    /** Adds the types of all available component libraries. @return diagnostics of the libraries that cannot be
     *  loaded */
    types::Diagnostics loadAll();

private:
    void enter(const loader::ComponentLibrary& library);

    std::vector<Entry> entries_;
    std::set<std::string> entered_;  ///< Component libraries, by file.
    std::string entering_;           ///< The library that is being entered.
};

}  // namespace insonify::framework
