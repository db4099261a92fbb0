#include "components/loader/ComponentLibrary.hpp"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <set>
#include <string_view>

#include "components/loader/Interface.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::loader {
namespace {

namespace fs = std::filesystem;

constexpr Component all_components[] = {
    {"dataset", "data sets to learn from"},
    {"dds", "ROS 2 messages"},
    {"device", "simulated instruments, and their recordings"},
    {"gazebo", "poses and worlds of Gazebo"},
    {"mavlink", "poses of autopilots"},
    {"meshes", "meshes of .dae, .obj, .stl and .ply as scenes"},
    {"nav", "a DVL, an inertial unit and a pressure gauge"},
    {"sdf", "scenes in SDF and robots in URDF"},
    {"study", "studies of the simulator itself"},
    {"survey", "surveys of the sea floor"},
    {"video", "videos"},
    {"viewer", "the live view"},
    {"worlds", "scenes by recipe"},
};

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
    throw types::ConfigError(file.string(), "", why);
}

/** Returns the library or program of this code. */
fs::path ownFile() {
    Dl_info info{};
    std::error_code none;
    if (!dladdr(reinterpret_cast<const void*>(&folders), &info) || !info.dli_fname) return {};
    const fs::path file = fs::canonical(info.dli_fname, none);
    return none ? fs::canonical("/proc/self/exe", none) : file;
}

bool isName(const std::string& name) {
    const auto fits = [](char c) { return types::isLowerLetter(c) || types::isDigit(c) || c == '_'; };
    return !name.empty() && std::ranges::all_of(name, fits);
}

/** Returns the files of that name, each once even if several folders contain it. */
std::vector<fs::path> getFiles(const std::string& name) {
    std::vector<fs::path> files;
    for (const fs::path& folder : folders()) {
        std::error_code none;
        const fs::path file = fs::canonical(folder / (name + ".so"), none);
        if (!none && std::ranges::count(files, file) == 0) files.push_back(file);
    }
    return files;
}

/** Returns why a file cannot be loaded. The system's loader would map the parts named in its headers even if they are
 *  missing. */
std::string findDamage(const fs::path& file) {
    std::error_code none;
    if (!fs::is_regular_file(file, none)) return "is no file";
    const uintmax_t size = fs::file_size(file, none);
    std::ifstream bytes(file, std::ios::binary);
    ElfW(Ehdr) head{};
    if (!bytes.read(reinterpret_cast<char*>(&head), sizeof head) || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0)
        return "is no shared object";
    bytes.seekg(static_cast<std::streamoff>(head.e_phoff));
    for (int i = 0; i < head.e_phnum; ++i) {
        ElfW(Phdr) part{};
        const bool read = static_cast<bool>(bytes.read(reinterpret_cast<char*>(&part), sizeof part));
        if (!read || part.p_offset > size || part.p_filesz > size - part.p_offset) return "is cut short";
    }
    return "";
}

/** Returns the version in a file, read before its code runs; empty: there is none. */
std::string getVersion(const fs::path& file) {
    static constexpr std::string_view before = interface_mark;
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    for (size_t at = bytes.find(before); at != std::string::npos; at = bytes.find(before, at + 1)) {
        const std::string version(bytes.c_str() + at + before.size());
        if (!version.empty() && version.size() < 64) return version;
    }
    return "";
}

void refuseOtherVersion(const fs::path& file) {
    const std::string version = getVersion(file);
    if (version == interface_version) return;
    if (version.empty()) refuse(file, "has no line INSONIFY_COMPONENT_LIBRARY, which every component library has");
    refuse(file, "is for Insonify " + version + "; this is " + interface_version + ": rebuild it");
}

struct Loaded {
    std::mutex mutex;
    std::map<fs::path, ComponentLibrary> all;
};

Loaded& loaded() {
    static Loaded loaded;
    return loaded;
}

/** Makes the framework's symbols visible to users' libraries that are linked with nothing. Python would hide them. */
void showOwnSymbols() {
    static const bool shown = [] {
        const fs::path own = ownFile();
        return own.filename().string().find(".so") != std::string::npos &&
               dlopen(own.c_str(), RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL) != nullptr;
    }();
    static_cast<void>(shown);
}

const ComponentLibrary& open(const fs::path& file) {
    const std::lock_guard alone(loaded().mutex);
    if (const auto known = loaded().all.find(file); known != loaded().all.end()) return known->second;
    if (const std::string damage = findDamage(file); !damage.empty()) refuse(file, "cannot be loaded: it " + damage);
    refuseOtherVersion(file);
    showOwnSymbols();
    void* const handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) refuse(file, std::string("cannot be loaded: ") + dlerror());
    return loaded().all.try_emplace(file, file, handle).first->second;
}

}  // namespace

std::span<const Component> components() { return all_components; }

const Component* findComponent(const std::string& name) {
    const auto found = std::ranges::find(all_components, name, &Component::name);
    return found == std::end(all_components) ? nullptr : found;
}

void* ComponentLibrary::find(const char* name) const { return dlsym(handle_, name); }

std::vector<fs::path> folders() {
    std::vector<fs::path> all;
    const char* const given = secure_getenv("INSONIFY_COMPONENT_PATH");
    std::string rest = given ? given : "";
    while (!rest.empty()) {
        const size_t end = std::min(rest.find(':'), rest.size());
        const fs::path folder = rest.substr(0, end);
        if (!folder.is_absolute())
            throw types::ConfigError(
                "", "INSONIFY_COMPONENT_PATH",
                "has the folder \"" + folder.string() + "\"; must be absolute: /opt/auv:/home/me/parts");
        all.push_back(folder);
        rest.erase(0, end + 1);
    }
    const fs::path own = ownFile().parent_path();
    for (const fs::path& folder : {own / "insonify", own.parent_path() / "lib" / "insonify"})
        if (std::error_code none; fs::is_directory(folder, none)) {
            all.push_back(folder);
            break;
        }
    return all;
}

std::vector<std::string> present() {
    std::set<std::string> names;
    for (const fs::path& folder : folders()) {
        std::error_code none;
        for (const auto& entry : fs::directory_iterator(folder, none))
            if (entry.path().extension() == ".so" && isName(entry.path().stem())) names.insert(entry.path().stem());
    }
    return {names.begin(), names.end()};
}

bool isPresent(const std::string& name) { return isName(name) && !getFiles(name).empty(); }

const ComponentLibrary& load(const std::string& name) {
    const std::vector<fs::path> files = isName(name) ? getFiles(name) : std::vector<fs::path>{};
    if (files.empty()) throw types::ConfigError("", "", "needs " + absence(name));
    if (files.size() > 1)
        refuse(files[0], "is the component library " + name + ", and so is " + files[1].string() + "; one is allowed");
    return open(files[0]);
}

const ComponentLibrary& loadFile(const fs::path& file) {
    std::error_code none;
    const fs::path whole = fs::canonical(file, none);
    if (none) refuse(file, "cannot be loaded: " + none.message());
    return open(whole);
}

Installation findInstallation(const fs::path& own) {
    const fs::path around = own.parent_path().parent_path();
    std::error_code none;
    if (fs::exists(around / "build.ninja", none)) return Installation::Clone;
    if (fs::exists(around / "__init__.py", none) || fs::exists(around.parent_path() / "insonify.libs", none))
        return Installation::Wheel;
    const std::string path = own.string();
    return path.starts_with("/usr/") && !path.starts_with("/usr/local/") ? Installation::DebianPackage
                                                                         : Installation::Prefix;
}

std::string absence(const std::string& name) { return absence(name, findInstallation(ownFile())); }

std::string absence(const std::string& name, Installation installation) {
#if defined(__aarch64__)
    constexpr const char* processor = "arm64";
#else
    constexpr const char* processor = "amd64";
#endif
    const std::string version = std::string(interface_version).substr(0, std::string(interface_version).find(' '));
    const std::string package = "insonify-" + name + "_" + version + "_" + processor + ".deb";
    const std::string library = "the component library " + name;
    switch (installation) {
        case Installation::Clone: return library + ", which is not here; `scripts/setup " + name + "` installs it";
        case Installation::Wheel:
            return library + ", which is not in wheels and archives; it is in " + package +
                   ", which `scripts/package` makes in a clone of the repository";
        case Installation::DebianPackage:
            return library + ", which is not here; `apt install ./" + package +
                   "` installs it: `scripts/package` has made that file next to the package of insonify";
        case Installation::Prefix: break;
    }
    return library + ", which is not here; `scripts/setup " + name +
           "` and then `cmake --install build` install it, in the clone that this is from";
}

fs::path sharedFolder() {
    for (fs::path around = ownFile().parent_path(); around.has_relative_path(); around = around.parent_path()) {
        std::error_code none;
        if (const fs::path shared = around / "share" / "insonify"; fs::exists(shared / "deploy", none)) return shared;
        if (fs::exists(around / "deploy" / "minimal.yml", none)) return around;
    }
    return {};
}

std::string locatePages(const std::string& text) {
    constexpr std::string_view begin = "components/", end = ".md";
    const fs::path shared = sharedFolder();
    std::string located = text;
    for (size_t at = located.find(begin), last = 0; at != located.npos; at = located.find(begin, last)) {
        if (last = located.find(end, at); last == located.npos) break;
        last += end.size();
        const std::string page = located.substr(at, last - at);
        for (const fs::path& folder : {shared.parent_path() / "doc" / "insonify", shared})
            if (std::error_code none; fs::exists(folder / page, none)) {
                located.replace(at, page.size(), (folder / page).string());
                last = at + (folder / page).string().size();
                break;
            }
    }
    return located;
}

}  // namespace insonify::loader
