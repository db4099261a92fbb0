#include "components/deployer/ShardFolder.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include "components/console/Console.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Sha256.hpp"

namespace insonify::deployer {
namespace fs = std::filesystem;
namespace {

using console::Json;

constexpr const char* manifest_name = "manifest.json";

/** Returns the manifest; none: there is no file, or it is not a manifest in JSON. */
std::optional<Json> manifestIn(const fs::path& folder) {
    std::ifstream file(folder / manifest_name);
    Json manifest = console::readJson(std::string(std::istreambuf_iterator<char>(file), {}));
    if (!manifest.is_object() || !manifest.contains("files") || !manifest["files"].is_array()) return std::nullopt;
    return manifest;
}

/** Returns the files of a folder, by their sorted names within it. */
std::vector<fs::path> filesIn(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(folder));
    std::ranges::sort(files);
    return files;
}

Json findEntry(const fs::path& folder, const fs::path& file) {
    return {{"file", file.generic_string()},
            {"bytes", fs::file_size(folder / file)},
            {"sha256", types::sha256OfFile(folder / file)}};
}

/** Returns the first difference of a folder from its manifest; empty: none. */
std::string findDamage(const fs::path& folder, const Json& manifest) try {
    for (const Json& entry : manifest["files"]) {
        const fs::path file = entry.value("file", "");
        std::error_code absent;
        const uint64_t bytes = fs::file_size(folder / file, absent);
        if (absent) return file.string() + " is missing";
        if (bytes != entry.value("bytes", uint64_t{0}))
            return fmt::format("{} has {} bytes, not {}", file.string(), bytes, entry.value("bytes", uint64_t{0}));
        if (types::sha256OfFile(folder / file) != entry.value("sha256", ""))
            return file.string() + " has another SHA-256 than when it was written";
    }
    for (const char* key : {"pings", "first_ping", "pings_of_run"})
        if (!manifest.at(key).is_number_unsigned()) return std::string("its manifest.json has no number of ") + key;
    return {};
} catch (const Json::exception& error) {
    return std::string("its manifest.json is broken: ") + error.what();
}

/** Returns the first key whose values differ, with both values; empty: none. */
std::string findDifference(const Json& there, const Json& asked) {
    for (const auto& [key, value] : asked.items()) {
        const Json& before = there.contains(key) ? there[key] : Json();
        if (before != value) return fmt::format("{} is {} there, and {} here", key, before.dump(), value.dump());
    }
    return {};
}

/** "shard_03_of_16" -> "16"; empty: not a shard. */
std::string countEach(const fs::path& folder) {
    const std::string name = folder.filename().string();
    const size_t of = name.rfind("_of_");
    return name.starts_with("shard_") && of != name.npos ? name.substr(of + 4) : "";
}

}  // namespace

ShardFolder::Lock::Lock(const fs::path& folder, bool waits)
    : folder_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    holds_ = folder_ >= 0 && flock(folder_, LOCK_EX | (waits ? 0 : LOCK_NB)) == 0;
}

ShardFolder::Lock::~Lock() {
    if (folder_ >= 0) close(folder_);
}

ShardFolder::ShardFolder(const fs::path& shared, const console::Shard& shard, Json run)
    : shared_(shared), path_(shared / ("shard_" + shard.fileText())), shard_(shard), run_(std::move(run)) {
    std::error_code failed;
    fs::create_directories(shared_, failed);
    if (failed || !fs::is_directory(shared_))
        throw types::ConfigError(shared_, "--out", "is no folder and cannot be made: " + failed.message());
    refuseOthers();
}

ShardFolder::~ShardFolder() {
    std::error_code ignored;
    if (!part_.empty()) fs::remove_all(part_, ignored);
}

void ShardFolder::refuseOthers() const {
    for (const auto& entry : fs::directory_iterator(shared_)) {
        const std::string count = countEach(entry.path());
        if (count.empty()) continue;
        if (count != std::to_string(shard_.count))
            throw types::ConfigError(
                shared_, "--out",
                fmt::format("holds shards of {}, and this is one of {}; give another folder", count, shard_.count));
        const auto manifest = manifestIn(entry.path());
        if (!manifest) continue;
        const std::string difference = findDifference(manifest->value("run", Json::object()), run_);
        if (!difference.empty())
            throw types::ConfigError(shared_, "--out",
                                     "holds shards of another run: " + difference + "; give another folder");
    }
}

std::optional<Json> ShardFolder::done() const {
    if (!fs::exists(path_)) return std::nullopt;
    const auto manifest = manifestIn(path_);
    const std::string damage = manifest ? findDamage(path_, *manifest) : "its manifest.json is missing or broken";
    if (damage.empty()) return manifest;
    console::printDiagnostic("notice: {}: {}; the shard is made again\n", path_.string(), damage);
    return std::nullopt;
}

void ShardFolder::removeLeft() const {
    const std::string beginning = "." + path_.filename().string() + ".";
    for (const auto& entry : fs::directory_iterator(shared_)) {
        if (!entry.path().filename().string().starts_with(beginning)) continue;
        const Lock lock(entry.path(), false);
        if (!lock.holds()) continue;  // another process uses it
        std::error_code ignored;
        fs::remove_all(entry.path(), ignored);
    }
}

const fs::path& ShardFolder::begin() {
    const Lock together(shared_, true);  // no other process must mistake the unlocked new folder for a leftover
    removeLeft();
    std::string name = shared_ / ("." + path_.filename().string() + ".XXXXXX");
    if (!mkdtemp(name.data())) throw types::ConfigError(shared_, "--out", "cannot be written to");
    part_ = name;
    fs::permissions(part_, fs::status(shared_).permissions());
    lock_.emplace(part_, false);
    return part_;
}

Json ShardFolder::finish(const Json& more) {
    Json manifest = {{"shard", shard_.text()}, {"run", run_}};
    manifest.update(more);
    manifest["files"] = Json::array();
    for (const fs::path& file : filesIn(part_)) manifest["files"].push_back(findEntry(part_, file));
    console::write(manifest, part_ / manifest_name);
    const Lock together(shared_, true);
    refuseOthers();  // shards that were finished meanwhile
    if (fs::exists(path_)) {
        const auto first = manifestIn(path_);
        if (first && findDamage(path_, *first).empty()) return *first;
        fs::remove_all(path_);  // damaged, and made again
    }
    std::error_code failed;
    fs::rename(part_, path_, failed);
    if (!failed) {
        part_.clear();
        return manifest;
    }
    throw std::runtime_error(fmt::format("{}: cannot become {}: {}", part_.string(), path_.string(), failed.message()));
}

}  // namespace insonify::deployer
