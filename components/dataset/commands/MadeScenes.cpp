#include "components/dataset/commands/MadeScenes.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "components/command/Sha256.hpp"
#include "components/loader/ComponentLibrary.hpp"
#include "types/ConfigError.hpp"

namespace insonify::dataset {
namespace {

namespace fs = std::filesystem;

/** Makes a folder among the files of all users, unless it exists. Throws types::ConfigError if another user owns it or
 *  may write to it: that user's scenes would become part of a data set. */
fs::path ownFolder(const fs::path& path) {
    mkdir(path.c_str(), S_IRWXU);
    struct stat status {};
    const bool is_own = lstat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == geteuid() &&
                        (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
    if (is_own) return path;
    throw types::ConfigError(path.string(), "",
                             "is not a folder that only this user may write to; HOME or XDG_CACHE_HOME names another "
                             "cache of made scenes");
}

/** Returns the folder of made scenes: by the XDG base directory specification, or the folder of temporary files. */
fs::path cacheFolder() {
    const auto valueOf = [](const char* name) { return fs::path(std::getenv(name) ? std::getenv(name) : ""); };
    fs::path base = valueOf("XDG_CACHE_HOME");
    if (!base.is_absolute() && valueOf("HOME").is_absolute()) base = valueOf("HOME") / ".cache";
    if (!base.is_absolute()) base = ownFolder(fs::temp_directory_path() / fmt::format("insonify-{}", geteuid()));
    return base / "insonify" / "scenes";
}

std::string generatorDigest() {
    std::string digest;
    loader::load("worlds").entry<void(std::string&)>("insonify_generator_digest")(digest);
    return digest;
}

std::string originOf(const SceneChoice& scene, const std::string& generator) {
    return fmt::format("recipe {} seed {} generator {}\n", command::sha256OfFile(scene.recipe), scene.seed, generator);
}

/** Returns the file of a scene, which is made if it does not exist. It is renamed to its final name when complete,
 *  because other processes may make it too. */
std::string madeFile(const SceneChoice& scene, const std::string& generator) {
    const fs::path folder = cacheFolder() / command::sha256Of(originOf(scene, generator)).substr(0, 32);
    const std::string stem = fmt::format("{}_{}", fs::path(scene.recipe).stem().string(), scene.seed);
    const fs::path file = folder / (stem + ".glb"), passing = folder / fmt::format("{}.{}.glb", stem, getpid());
    if (fs::is_regular_file(file)) return file;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw types::ConfigError(
            folder.string(), "",
            fmt::format("cannot be made: {}; XDG_CACHE_HOME names another cache", error.message()));
    loader::load("worlds").entry<void(const std::vector<std::string>&)>("insonify_make_scene")(
        {"--recipe=" + scene.recipe, fmt::format("--seed={}", scene.seed), "--out=" + passing.string(), "--quiet"});
    fs::rename(passing, file);
    return file;
}

bool hasRecipe(const SceneChoice& scene) { return !scene.recipe.empty(); }

}  // namespace

Sweep withMadeScenes(Sweep sweep) {
    if (std::ranges::none_of(sweep.scenes, hasRecipe)) return sweep;
    const std::string generator = generatorDigest();
    for (SceneChoice& scene : sweep.scenes)
        if (hasRecipe(scene)) scene.file = madeFile(scene, generator);
    return sweep;
}

std::string originsOf(const Sweep& sweep) {
    if (std::ranges::none_of(sweep.scenes, hasRecipe)) return "";
    const std::string generator = generatorDigest();
    std::string text;
    for (const SceneChoice& scene : sweep.scenes)
        if (hasRecipe(scene)) text += originOf(scene, generator);
    return text;
}

}  // namespace insonify::dataset
