#include "components/meshes/ModelPaths.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "types/NamedFile.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::meshes {
namespace {

using std::filesystem::path;

/** Whether there is a file or a folder; a pipe or a device is neither. */
bool isThere(const path& place) {
    std::error_code error;
    return std::filesystem::is_regular_file(place, error) || std::filesystem::is_directory(place, error);
}

std::optional<path> ifThere(path place) { return isThere(place) ? std::optional(std::move(place)) : std::nullopt; }

/** Returns the folders of a list in the environment, separated by ':'. */
std::vector<path> foldersIn(const char* variable) {
    std::vector<path> folders;
    const char* const list = std::getenv(variable);
    std::istringstream stream(list ? list : "");
    for (std::string folder; std::getline(stream, folder, ':');)
        if (!folder.empty()) folders.push_back(std::filesystem::absolute(folder));
    return folders;
}

path home() { return std::getenv("HOME") ? std::getenv("HOME") : ""; }

constexpr const char* model_variables[] = {"INSONIFY_MODEL_PATH",  "GAZEBO_MODEL_PATH",        "SDF_PATH",
                                           "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "GAZEBO_RESOURCE_PATH"};

/** Returns the text with "%20" as " "; a '%' without two digits stays, and %00. */
std::string decoded(std::string_view text) {
    std::string out;
    for (size_t i = 0; i < text.size(); ++i) {
        unsigned byte = 0;
        const char* const end = text.data() + std::min(i + 3, text.size());
        if (text[i] == '%' && end == text.data() + i + 3 &&
            std::from_chars(text.data() + i + 1, end, byte, 16).ptr == end && byte != 0) {
            out += static_cast<char>(byte);
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

/** Returns the root of the repository that contains a folder, else the folder that contains its ROS package; empty:
 *  neither. */
path rootAbove(const path& folder) {
    constexpr int levels = 10;
    path package;
    path at = folder;
    for (int i = 0; i < levels && at.has_relative_path(); ++i, at = at.parent_path()) {
        if (isThere(at / ".git")) return at;
        if (package.empty() && isThere(at / "package.xml")) package = at.parent_path();
    }
    return package;
}

/** Returns the name in a package.xml; that of the folder where the file has none. */
std::string packageName(const path& folder) {
    std::ifstream file(folder / "package.xml");
    std::string text(1 << 14, '\0');
    text.resize(static_cast<size_t>(file.read(text.data(), static_cast<std::streamsize>(text.size())).gcount()));
    const size_t begin = text.find("<name>"), end = text.find("</name>");
    if (begin == std::string::npos || end == std::string::npos || end < begin) return folder.filename().string();
    const std::string name = text.substr(begin + 6, end - begin - 6);
    const size_t first = name.find_first_not_of(" \t\r\n"), last = name.find_last_not_of(" \t\r\n");
    return first == std::string::npos ? folder.filename().string() : name.substr(first, last - first + 1);
}

/** Adds the ROS packages and the folders of models at and below a folder. The nearest of a name stays, so that the
 * limit of `left` entries cuts what is deepest. Links are followed, once each; hidden folders and those that a build
 * made are not searched. */
void findNamed(const path& root, size_t& left, std::map<std::string, path>& named) {
    constexpr int deepest = 8;
    std::error_code error;
    std::set<path> seen;
    std::vector<path> level = {root};
    for (int depth = 0; depth <= deepest && !level.empty(); ++depth) {
        std::vector<path> below;
        for (const path& folder : level) {
            if (!seen.insert(std::filesystem::weakly_canonical(folder, error)).second) continue;
            if (isThere(folder / "CMakeCache.txt")) continue;
            if (isThere(folder / "package.xml")) named.try_emplace(packageName(folder), folder);
            if (isThere(folder / "model.config")) named.try_emplace(folder.filename().string(), folder);
            for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
                if (left-- == 0) return void(left = 0);
                if (entry.is_directory(error) && !entry.path().filename().string().starts_with('.'))
                    below.push_back(entry.path());
            }
        }
        std::ranges::sort(below);
        level = std::move(below);
    }
}

/** A model of Fuel: https://HOST/1.0/OWNER/models/NAME/VERSION/files/FILE. */
struct FuelUrl {
    std::string host, owner, name, version, file;  ///< In lower case but `file`, as in the caches.

    static std::optional<FuelUrl> parse(const std::string& uri) {
        if (!uri.starts_with("https://") && !uri.starts_with("http://")) return {};
        std::vector<std::string> parts;
        std::istringstream stream(uri.substr(uri.find("://") + 3));
        for (std::string part; std::getline(stream, part, '/');)
            if (!part.empty()) parts.push_back(decoded(part));
        const auto models = std::ranges::find(parts, "models");
        if (parts.empty() || models - parts.begin() < 2 || parts.end() - models < 2) return {};
        FuelUrl url{parts.front(), *(models - 1), *(models + 1), "", ""};
        if (url.owner == "fuel" && models - parts.begin() > 2) url.owner = *(models - 2);
        for (std::string* word : {&url.host, &url.owner, &url.name}) *word = types::lowered(*word);
        auto next = models + 2;
        if (next != parts.end() && *next != "files") url.version = *next++;
        if (url.version == "tip") url.version.clear();
        if (next != parts.end() && *next == "files") ++next;
        for (; next != parts.end(); ++next) url.file += (url.file.empty() ? "" : "/") + *next;
        return url;
    }
};

std::vector<path> fuelCaches() {
    std::vector<path> caches;
    for (const char* variable : {"GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH"})
        for (const path& folder : foldersIn(variable)) caches.push_back(folder);
    caches.insert(caches.end(), {home() / ".gz/fuel", home() / ".ignition/fuel"});
    return caches;
}

/** Returns the folder of the newest version of a model, whose versions are folders with numbers. */
std::optional<path> newestIn(const path& model) {
    std::optional<path> newest;
    long highest = -1;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(model, error)) {
        const std::string name = entry.path().filename().string();
        long version = -1;
        if (std::from_chars(name.data(), name.data() + name.size(), version).ptr != name.data() + name.size()) continue;
        if (version > highest) highest = version, newest = entry.path();
    }
    return newest;
}

/** Returns a model of Fuel, or its file, in the caches of Gazebo: by its host, else by another. */
std::optional<path> findInFuel(const FuelUrl& url) {
    std::error_code error;
    for (const path& cache : fuelCaches()) {
        std::vector<path> hosts = {cache / url.host};
        for (const auto& entry : std::filesystem::directory_iterator(cache, error)) hosts.push_back(entry.path());
        for (const path& host : hosts) {
            const path model = host / url.owner / "models" / url.name;
            const auto version = url.version.empty() ? newestIn(model) : std::optional(model / url.version);
            if (version && isThere(*version / url.file)) return url.file.empty() ? *version : *version / url.file;
        }
    }
    return {};
}

}  // namespace

ModelPaths::ModelPaths(const path& world, Reach reach) : reach_(reach) {
    const auto add = [this](const path& folder) {
        if (std::ranges::find(folders_, folder) == folders_.end()) folders_.push_back(folder);
    };
    for (const char* variable : model_variables) std::ranges::for_each(foldersIn(variable), add);
    trusted_ = folders_;
    const path folder = std::filesystem::absolute(world).lexically_normal().parent_path();
    add(folder);
    if (isThere(folder / "model.config")) add(folder.parent_path());
    root_ = rootAbove(folder);
    for (path at = folder; !root_.empty(); at = at.parent_path()) {
        add(at);
        if (isThere(at / "models")) add(at / "models");
        if (at == root_) break;
    }
    own_.assign(folders_.begin() + static_cast<ptrdiff_t>(trusted_.size()), folders_.end());
    std::error_code error;
    const path real = std::filesystem::weakly_canonical(world, error).parent_path();  // of a world that is a link
    for (const path& own : {real, rootAbove(real)})
        if (!own.empty()) own_.push_back(own);
    for (const path& own :
         {home() / ".gazebo/models", path("/usr/share/gazebo-11/models"), path("/usr/share/gazebo-11")})
        if (isThere(own)) add(own), trusted_.push_back(own);
    for (const char* variable : {"AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"})
        for (const path& packages : foldersIn(variable)) trusted_.push_back(packages);
    for (const path& cache : fuelCaches()) trusted_.push_back(cache);
}

std::optional<path> ModelPaths::find(const std::string& uri, const path& named_in) const {
    auto found = findRaw(uri, named_in);
    if (const std::string plain = decoded(uri); !found && plain != uri) found = findRaw(plain, named_in);
    return found && mayRead(*found, named_in) ? found : std::nullopt;
}

bool ModelPaths::mayRead(const path& file, const path& named_in) const {
    if (reach_ == Reach::Anywhere) return true;
    const auto isWithin = [plain = file.lexically_normal()](const path& folder) {
        const path below = plain.lexically_relative(folder.lexically_normal());
        return !below.empty() && *below.begin() != "..";
    };
    const auto isOwn = [&](const path& folder) { return types::isBelow(file, folder); };
    return std::ranges::any_of(trusted_, isWithin) || std::ranges::any_of(own_, isOwn) ||
           (named_in.is_absolute() && types::belongsTo(file, named_in));
}

namespace {

/** Returns the scheme and the rest of a URI; an empty rest for a scheme that is not searched. */
std::pair<std::string, path> parted(const std::string& uri) {
    const size_t end = uri.find("://");
    if (end == std::string::npos) return {"", uri};
    const std::string scheme = uri.substr(0, end);
    const bool is_searched = scheme == "model" || scheme == "package" || scheme == "file";
    return {scheme, is_searched ? uri.substr(end + 3) : ""};
}

}  // namespace

std::optional<path> ModelPaths::findRaw(const std::string& uri, const path& named_in) const {
    if (const auto url = FuelUrl::parse(uri)) return findInFuel(*url);
    const auto [scheme, place] = parted(uri);
    if (place.is_absolute()) return ifThere(place);
    if (place.empty()) return {};
    const path own_folder = named_in.is_absolute() ? named_in.parent_path() : path();
    if (scheme.empty() && !own_folder.empty())
        if (auto found = ifThere(own_folder / place)) return found;
    for (const path& folder : folders_)
        if (auto found = ifThere(folder / place)) return found;
    const bool is_name = std::distance(place.begin(), place.end()) == 1;
    if (scheme.empty() && !is_name) return {};
    if (auto found = findByName(place)) return found;
    // A model of Fuel names its files by its own name, and is in a folder with the number of its version.
    if (is_name || own_folder.empty() || !isThere(own_folder / "model.config")) return {};
    return ifThere(own_folder / place.lexically_relative(*place.begin()));
}

std::optional<path> ModelPaths::findByName(const path& place) const {
    const path name = *place.begin(), rest = place.lexically_relative(name);
    for (const path& prefix : foldersIn("AMENT_PREFIX_PATH"))
        if (isThere(prefix / "share" / place)) return prefix / "share" / place;
    if (!named_) {
        named_.emplace();
        size_t left = 50'000;  // entries of folders
        for (const path& folder : foldersIn("ROS_PACKAGE_PATH")) findNamed(folder, left, *named_);
        if (!root_.empty()) findNamed(root_, left, *named_);
    }
    const auto found = named_->find(name.string());
    if (found == named_->end()) return {};
    if (rest == ".") return found->second;
    return ifThere(found->second / rest);
}

std::string ModelPaths::searched(const std::string& uri) const {
    const auto listed = [](const std::vector<path>& places) {
        std::string text;
        for (const path& place : places) text += (text.empty() ? "" : ", ") + place.string();
        return text;
    };
    if (FuelUrl::parse(uri))
        return "models of Fuel are not downloaded: they were searched in " + listed(fuelCaches()) +
               "; `gz fuel download -u URL` puts one there";
    std::string text = "files of models were searched in " + listed(folders_);
    if (uri.starts_with("package://") || uri.starts_with("model://"))
        text += ", and as packages of ROS by AMENT_PREFIX_PATH and ROS_PACKAGE_PATH" +
                (root_.empty() ? "" : " and below " + root_.string());
    return text +
           "; files outside of these are not read; INSONIFY_MODEL_PATH adds folders, which contain the folders of the "
           "models";
}

}  // namespace insonify::meshes
