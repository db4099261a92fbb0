#pragma once
// Component libraries: the parts beyond the core, loaded when a deployment, a scene's file or a command names them.
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace insonify::loader {

/** A component of Insonify in its own library. Its name is that of the file without ".so", and of the namespace of its
 *  tasks. */
struct Component {
    const char* name;
    const char* gives;  ///< For users: "ROS 2 messages".
};
std::span<const Component> components();
/** Null if Insonify has no component of that name. */
const Component* findComponent(const std::string& name);

/** A loaded shared object; it stays loaded until the process ends. */
class ComponentLibrary {
public:
    ComponentLibrary(std::filesystem::path file, void* handle) : file_(std::move(file)), handle_(handle) {}
    const std::filesystem::path& file() const { return file_; }
    /** Returns an `extern "C"` function, such as `entry<void(Registry&)>("insonify_register")`; null if there is
     *  none. */
    template <class Function>
    Function* entry(const char* name) const {
        return reinterpret_cast<Function*>(find(name));
    }

private:
    void* find(const char* name) const;

    std::filesystem::path file_;
    void* handle_;
};

/** Returns the folders of component libraries: those of INSONIFY_COMPONENT_PATH, absolute and separated by colons, and
 *  the folder `insonify` next to the library of this code. The working folder is not searched. */
std::vector<std::filesystem::path> folders();

/** Returns the names of the available component libraries in alphabetical order; loads nothing. */
std::vector<std::string> present();
bool isPresent(const std::string& name);

/** Loads a library by its name; the same object each time; safe to call from any thread. Throws types::ConfigError when
 *  it is absent, in two folders, damaged, of another version, or lacks a dependency. */
const ComponentLibrary& load(const std::string& name);

/** Loads a user's library. Throws types::ConfigError as load() does. */
const ComponentLibrary& loadFile(const std::filesystem::path& file);

/** The installation of this program, which decides what installs a missing part. */
enum class Installation { Clone, Wheel, DebianPackage, Prefix };

/** Returns the installation that a library or program belongs to; wheels and archives are alike. */
Installation findInstallation(const std::filesystem::path& file);

/** Returns "the component library dds, which is not here; `scripts/setup dds` installs it", by what installs it in this
 *  installation or in a given one. */
std::string absence(const std::string& name);
std::string absence(const std::string& name, Installation installation);

/** Returns the folder that has the examples, in `deploy`: the clone, or share/insonify of an installation; empty: there
 *  is none. */
std::filesystem::path sharedFolder();

/** Returns a text in which each page of the repository, such as "components/device/README.md", is named by its path in
 *  this installation: in the clone, or share/doc/insonify of a package, prefix, archive or wheel. A page that is not
 *  there keeps its name. */
std::string locatePages(const std::string& text);

}  // namespace insonify::loader
