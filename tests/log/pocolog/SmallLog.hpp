#pragma once
#include <vector>

#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Writer.hpp"
#include "tests/support/Folder.hpp"

namespace insonify::log::pocolog {

constexpr uint64_t sample_header = 29;  ///< Bytes of a block in front of its sample.

inline types::Sonar smallPing(int64_t time) {
    types::Sonar ping;
    ping.time = {time};
    ping.bearings = {{0.1}, {0.2}};
    ping.beam_count = 2;
    ping.bin_count = 3;
    ping.bins = {1, 2, 3, 4, 5, 6};
    return ping;
}

/** Writes a stream of three pings and one of two poses, a ping last, to whole.0.log. */
inline std::vector<char> smallLog(const Folder& folder) {
    Writer log(folder / "whole.0.log");
    const size_t ping = log.addStream<types::Sonar>("sonar.ping");
    const size_t pose = log.addStream<types::Pose>("vehicle.pose");
    for (int64_t i = 1; i <= 3; ++i) {
        if (i < 3) log.write(pose, {i}, types::Pose{});
        log.write(ping, {i}, smallPing(i));
    }
    log.close();
    return toBytes(folder / "whole.0.log");
}

/** Returns the positions of the blocks of the small log's samples [B]. */
inline std::vector<uint64_t> sampleBlocks(const std::filesystem::path& path) {
    std::vector<uint64_t> blocks;
    const Reader log(path);
    for (const SampleRef& at : log.samples()) blocks.push_back(at.position - sample_header);
    return blocks;
}

}  // namespace insonify::log::pocolog
