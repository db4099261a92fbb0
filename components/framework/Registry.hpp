#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "components/framework/TaskContext.hpp"

namespace insonify::framework {

/** The task types that a deployment may name. Filled explicitly: by main, and by component libraries. */
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
    /** Null when there is no such type. */
    std::unique_ptr<TaskContext> make(const std::string& type, const std::string& name) const;
    const std::vector<Entry>& list() const { return entries_; }  ///< In order of registration.

    /** Loads a shared object and calls its `extern "C" void insonify_register(insonify::framework::Registry&)`.
     *  It stays loaded until the process ends. Throws types::ConfigError: not there, not loadable, no such entry. */
    void loadLibrary(const std::filesystem::path& file);

private:
    std::vector<Entry> entries_;
};

/** Tells that this build has no task types whose names begin so, for want of a package when it was built. For one
 *  thread, before deployments are made. */
void leaveOut(const std::string& begin, const std::string& package);

/** ", which is left out of this build: ..." for such a type, else empty. */
std::string whyLeftOut(const std::string& type);

}  // namespace insonify::framework
