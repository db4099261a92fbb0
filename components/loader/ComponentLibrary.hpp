#pragma once
// Component libraries: what a deployment, a scene's file or a command needs beyond the core is loaded when it is named.
#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace insonify::loader {

/** A component of Insonify that is a library of its own. Its name is that of the file without ".so", and of the
 * namespace of its tasks. */
struct Component {
    const char* name;
    const char* gives;                                  ///< For users: "ROS 2 messages".
    std::array<std::string_view, 2> file_endings = {};  ///< Files that need it: ".sdf".
};
std::span<const Component> components();
/** Null where Insonify has none of that name. */
const Component* findComponent(const std::string& name);

/** A shared object that is loaded, until the process ends. */
class ComponentLibrary {
public:
    ComponentLibrary(std::filesystem::path file, void* handle) : file_(std::move(file)), handle_(handle) {}
    const std::filesystem::path& file() const { return file_; }
    /** An `extern "C"` function, such as `entry<void(Registry&)>("insonify_register")`; null where it has none. */
    template <class Function>
    Function* entry(const char* name) const {
        return reinterpret_cast<Function*>(find(name));
    }

private:
    void* find(const char* name) const;

    std::filesystem::path file_;
    void* handle_;
};

/** Where component libraries are looked for: the folders of INSONIFY_COMPONENT_PATH, separated by colons, which must be
 *  absolute, and the folder `insonify` beside the library that this code is in. The working folder is none of them. */
std::vector<std::filesystem::path> folders();

/** Names of the component libraries that are there, in order of the alphabet; nothing is loaded. */
std::vector<std::string> present();
bool isPresent(const std::string& name);

/** Loads a library by its name, the same each time; safe to call from any thread. Throws types::ConfigError: it is
 * absent, in two folders, damaged, of another version, or needs what is not there. */
const ComponentLibrary& load(const std::string& name);

/** Loads a library of a user's. Throws types::ConfigError as above. */
const ComponentLibrary& loadFile(const std::filesystem::path& file);

/** "the component library dds, which is not here; `scripts/setup dds` installs it". */
std::string absence(const std::string& name);

}  // namespace insonify::loader
