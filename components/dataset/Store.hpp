#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "components/command/Json.hpp"

namespace insonify::dataset {

using command::Json;

/** On one line; text that is no UTF-8 is mended. */
std::string textOf(const Json& json);

/** The folder of a data set. Each sample is a few files of one stem, "000042_<hash>", and complete once its record,
 *  "000042_<hash>.json", is there, which names the others with their sums. Files come to their names whole; several
 *  processes may work in one folder. */
class Store {
public:
    /** @param digest of all that decides what samples are. Throws types::ConfigError where the folder holds samples of
     *  another data set. */
    Store(std::filesystem::path folder, std::string digest);

    const std::filesystem::path& folder() const { return folder_; }
    const std::string& digest() const { return digest_; }
    std::string stemOf(uint64_t index) const;

    /** Has `writer` make a file under another name, gives it this one, and returns its SHA-256. */
    std::string put(const std::string& name, const std::function<void(const std::filesystem::path&)>& writer);
    std::string putText(const std::string& name, const std::string& text);

    /** Completes a sample. */
    void putRecord(uint64_t index, Json record);
    /** Of a sample; none where it is missing or damaged. */
    std::optional<Json> record(uint64_t index) const;
    /** Whether a sample has its record, and each file that this names is as it was written. */
    bool has(uint64_t index) const;
    /** Removes what writers that were killed have left, once all samples are there. Writers that live write again. */
    void removeLeftovers() const;

private:
    void refuseOthers() const;

    std::filesystem::path folder_;
    std::string digest_;
};

}  // namespace insonify::dataset
