#include "components/study/Recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "types/ConfigError.hpp"

namespace insonify::study {
namespace {

namespace fs = std::filesystem;

/** The files that are named, and those in the folders that are. */
std::vector<fs::path> filesOf(const std::vector<std::string>& names) {
    std::vector<fs::path> files;
    for (const fs::path name : names) {
        if (!fs::is_directory(name)) {
            files.push_back(name);
            continue;
        }
        for (const auto& entry : fs::directory_iterator(name))
            if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

}  // namespace

std::vector<CodedPing> recordedPings(const std::vector<std::string>& names) {
    std::vector<CodedPing> pings;
    for (const fs::path& file : filesOf(names))
        for (const device::OculusPing& ping : device::readOculusPings(file)) {
            CodedPing coded = codedPing(ping, fmt::format("recorded_{}", ping.number));
            coded.file = file.string();
            const auto isSame = [&](const CodedPing& other) {
                return other.name == coded.name && other.codes == coded.codes;
            };
            if (std::ranges::none_of(pings, isSame)) pings.push_back(std::move(coded));
        }
    if (pings.empty()) throw types::ConfigError(names.front(), "--real", "is a folder without a file");
    return pings;
}

}  // namespace insonify::study
