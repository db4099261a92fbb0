#pragma once
#include <cstdint>
#include <string>

namespace insonify::console {

/** One part of a divided piece of work, `i/N`: i is from 0 to N - 1, as schedulers count. The parts are disjoint and
 *  together are the whole. */
struct Shard {
    uint64_t index = 0, count = 1;

    static constexpr uint64_t maximum = 1'000'000'000;  ///< Max number of parts [1].

    /** Parses "3/16". Throws types::ConfigError that names `option`. */
    static Shard read(const std::string& text, const std::string& option = "--shard");
    std::string text() const;  ///< "3/16"
    /** For files: "03_of_16", so that names sort like numbers. */
    std::string fileText() const;

    /** The block of the items 0 to `total` - 1 in this part; `last` is excluded. Blocks are consecutive and differ by
     *  at most one item. */
    struct Block {
        uint64_t first, last;
        bool operator==(const Block&) const = default;
    };
    Block block(uint64_t total) const;
    /** Returns why `text` is not a shard; empty: it is a shard. For CLI::Option::check. */
    static std::string refuse(const std::string& text);

    bool operator==(const Shard&) const = default;
};

}  // namespace insonify::console
