#include "components/study/CodedPing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "types/BeamArc.hpp"
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

double CodedPing::levelDb(float code) const {
    const double least = 0.5 / (std::pow(2, bits) - 1), share = std::max(least, static_cast<double>(code));
    if (law.law == receiver::CodeLaw::Log) return (share - 1) * law.dynamic_range_db;
    return (law.law == receiver::CodeLaw::Sqrt ? 20 : 10) * std::log10(share) / law.gamma;
}

CodedPing codedPing(const device::OculusPing& ping, std::string name) {
    CodedPing coded{.name = std::move(name),
                    .beam_count = ping.beamCount(),
                    .bin_count = ping.bin_count,
                    .bearings = ping.bearings,
                    .codes = {},
                    .bits = std::min(ping.bits, 16),
                    .law = {.law = receiver::CodeLaw::Sqrt, .gamma = ping.gamma}};
    for (size_t i = 0; i < ping.codes.size(); ++i) {
        const double gain = ping.row_gains.empty() ? 1 : std::max(1u, ping.row_gains[i % ping.bin_count]);
        coded.codes.push_back(static_cast<float>(ping.codes[i] / std::sqrt(gain) / ping.largestCode()));
    }
    return coded;
}

CodedPing codedPing(const types::Sonar& ping, const receiver::CodeConfig& code, std::string name) {
    CodedPing coded{.name = std::move(name),
                    .beam_count = 0,
                    .bin_count = ping.bin_count,
                    .bearings = {},
                    .codes = {},
                    .bits = code.bits,
                    .law = code};
    const types::BeamArc arc(ping);  // neighbouring rows are neighbouring beams
    coded.beam_count = static_cast<uint32_t>(arc.beams.size());
    for (const uint32_t beam : arc.beams) {
        coded.bearings.push_back(ping.bearings[beam].rad);
        const auto bins = ping.bins.begin() + static_cast<std::ptrdiff_t>(size_t{beam} * ping.bin_count);
        coded.codes.insert(coded.codes.end(), bins, bins + ping.bin_count);
    }
    for (float& each : coded.codes) each /= static_cast<float>((1 << code.bits) - 1);
    return coded;
}

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
