#include "components/dataset/Store.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <iterator>
#include <random>
#include <string_view>
#include <system_error>

#include "components/console/Json.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/Sha256.hpp"

namespace insonify::dataset {
namespace fs = std::filesystem;
namespace {

constexpr const char* leftover = ".part_";
constexpr size_t hash_digits = 12;
constexpr int deepest_record = 64;  ///< Nesting of a sample's record, at most.

/** Returns a temporary name that is unique to this process on any machine that shares the folder. It keeps the
 *  extension, which determines the format. */
std::string passingName(const std::string& name) {
    static std::atomic<uint64_t> number{0};
    static const uint64_t process = uint64_t{std::random_device{}()} << 32 | static_cast<uint32_t>(::getpid());
    return fmt::format("{}{:016x}_{}_{}", leftover, process, ++number, name);
}

/** Returns the number of the sample that a file belongs to; none if it belongs to no sample. */
std::optional<uint64_t> findIndex(const std::string& name) {
    const size_t digits = name.find_first_not_of("0123456789");
    if (digits == std::string::npos || digits < 6 || digits > 18 || name[digits] != '_') return std::nullopt;
    const size_t end = name.find_first_not_of("0123456789abcdef", digits + 1);
    if (end != digits + 1 + hash_digits) return std::nullopt;
    return std::stoull(name.substr(0, digits));
}

std::string stem(const std::string& digest, uint64_t index) {
    return fmt::format("{:06}_{}", index, types::sha256(fmt::format("{}\n{}", digest, index)).substr(0, hash_digits));
}

std::string toBytes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string computeSum(Json record) {
    record.erase("sum");
    return types::sha256(toText(record));
}

}  // namespace

std::string toText(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string signedText(Json json) {
    json["sum"] = computeSum(json);
    return toText(json) + "\n";
}

std::optional<Json> readSigned(const fs::path& file) {
    if (!fs::exists(file)) return std::nullopt;
    Json json = console::readJson(toBytes(file), deepest_record);
    if (!json.is_object() || json.value("sum", Json()) != computeSum(json)) return std::nullopt;
    return json;
}

Store::Store(fs::path folder, std::string digest, const std::vector<std::string>& others)
    : folder_(std::move(folder)), digest_(std::move(digest)) {
    refuseOthers(others);
}

void Store::refuseOthers(const std::vector<std::string>& others) const {
    constexpr std::string_view of_whole_sets[] = {"manifest.json", "statistics.html", "data.yaml"};
    const auto isOwn = [&](uint64_t index, const std::string& name) {
        return name.starts_with(makeStem(index)) || std::ranges::any_of(others, [&](const std::string& digest) {
                   return name.starts_with(stem(digest, index));
               });
    };
    std::string foreign;
    bool has_own = false;
    for (const auto& entry : fs::directory_iterator(folder_)) {
        const std::string name = entry.path().filename();
        if (std::ranges::count(of_whole_sets, name) > 0 || name.starts_with("instances_") ||
            (name == description_file && !readSigned(entry.path())))
            foreign = name;
        const std::optional<uint64_t> index = findIndex(name);
        has_own |= index && isOwn(*index, name);
        if (index && !isOwn(*index, name))
            throw types::ConfigError(folder_, "--out",
                                     fmt::format("holds {}, a sample of another sweep, deployment, scene, format or "
                                                 "version; give an empty folder",
                                                 name));
    }
    if (!has_own && !foreign.empty())
        throw types::ConfigError(
            folder_, "--out", fmt::format("holds {}, which a data set would replace; give an empty folder", foreign));
}

std::string Store::makeStem(uint64_t index) const { return stem(digest_, index); }

std::string Store::put(const std::string& name, const std::function<void(const fs::path&)>& writer) {
    constexpr int max_tries = 5;
    for (int attempt = 1;; ++attempt) {
        const fs::path passing = folder_ / passingName(name);
        try {
            writer(passing);
            const std::string sum = types::sha256OfFile(passing);
            fs::rename(passing, folder_ / name);
            return sum;
        } catch (...) {
            std::error_code ignored;
            const bool was_taken = !fs::exists(passing, ignored);  // by a process that took it for a leftover
            fs::remove(passing, ignored);
            if (!was_taken || attempt == max_tries) throw;
        }
    }
}

std::string Store::putText(const std::string& name, const std::string& text) {
    return put(name, [&](const fs::path& file) {
        std::ofstream out(file, std::ios::binary);
        out << text;
        out.close();
        if (!out) throw std::runtime_error("cannot write " + file.string());
    });
}

void Store::putRecord(uint64_t index, Json record) {
    putText(makeStem(index) + ".json", signedText(std::move(record)));
}

std::optional<Json> Store::record(uint64_t index) const { return readSigned(folder_ / (makeStem(index) + ".json")); }

bool Store::has(uint64_t index) const {
    const std::optional<Json> found = record(index);
    if (!found) return false;
    for (const auto& [name, sum] : (*found)["files"].items())
        if (!name.starts_with(makeStem(index)) || name.find('/') != std::string::npos || !fs::exists(folder_ / name) ||
            types::sha256OfFile(folder_ / name) != sum.get<std::string>())
            return false;
    return true;
}

std::vector<uint64_t> Store::recorded() const {
    std::vector<uint64_t> all;
    for (const auto& entry : fs::directory_iterator(folder_)) {
        const std::string name = entry.path().filename();
        if (const auto index = findIndex(name); index && name == makeStem(*index) + ".json") all.push_back(*index);
    }
    std::ranges::sort(all);
    return all;
}

void Store::removeLeftovers() const {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder_))
        if (entry.path().filename().string().starts_with(leftover)) fs::remove_all(entry.path(), ignored);
}

}  // namespace insonify::dataset
