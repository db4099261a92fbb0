#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/console/Json.hpp"

namespace insonify::dataset {

using console::Json;

inline constexpr const char* description_file = "dataset.json";  ///< Describes the set of a folder, see Title.

/** Returns JSON in one line. Replaces invalid UTF-8. */
std::string toText(const Json& json);

/** Returns the bytes of a file of JSON: with the SHA-256 of the rest as its last key, `sum`. */
std::string signedText(Json json);
/** Returns the JSON of a file that signedText() has made; none if the file is missing or damaged. */
std::optional<Json> readSigned(const std::filesystem::path& file);

/** The folder of a data set. A sample consists of a few files with one stem, "000042_<hash>". It is complete when its
 *  record "000042_<hash>.json" exists, which names the other files with their sums. Files are renamed to their final
 *  names when complete; several processes may work in one folder. */
class Store {
public:
    /** @param digest hash of everything that determines the samples
     *  @param others digests of other samples in the folder, of a set that was joined from several
     *
     *  Throws types::ConfigError if the folder contains samples of another data set. */
    Store(std::filesystem::path folder, std::string digest, const std::vector<std::string>& others = {});

    const std::filesystem::path& folder() const { return folder_; }
    const std::string& digest() const { return digest_; }
    std::string makeStem(uint64_t index) const;

    /** Calls `writer` with a temporary name, renames the file to `name`, and returns its SHA-256. */
    std::string put(const std::string& name, const std::function<void(const std::filesystem::path&)>& writer);
    std::string putText(const std::string& name, const std::string& text);

    /** Writes the record of a sample, which completes the sample. */
    void putRecord(uint64_t index, Json record);
    /** Returns the record of a sample; none if it is missing or damaged. */
    std::optional<Json> record(uint64_t index) const;
    /** Returns whether a sample has its record, and each file named in it is unchanged. */
    bool has(uint64_t index) const;
    /** Returns the numbers of the samples that have a record, ascending. */
    std::vector<uint64_t> recorded() const;
    /** Removes files that killed writers have left. Call it when all samples exist. A live writer whose file was
     *  removed writes it again. */
    void removeLeftovers() const;

private:
    void refuseOthers(const std::vector<std::string>& others) const;

    std::filesystem::path folder_;
    std::string digest_;
};

}  // namespace insonify::dataset
