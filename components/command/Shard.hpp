#pragma once
#include <cstdint>
#include <string>

namespace insonify::command {

/** One of the parts into which a piece of work is cut, `i/N`: numbers from 0 to N - 1, so that what a scheduler counts
 *  from 0 can be handed on. All parts together are the whole, none has anything of another. */
struct Shard {
    uint64_t index = 0, count = 1;

    static constexpr uint64_t most = 1'000'000'000;  ///< Parts of a whole [1].

    /** "3/16". Throws types::ConfigError that names `option`. */
    static Shard read(const std::string& text, const std::string& option = "--shard");
    std::string text() const;  ///< "3/16"
    /** For files: "03_of_16", so that the order of names is that of numbers. */
    std::string fileText() const;

    /** The block of the items 0 to `total` - 1 that is this part's, `last` not included. Blocks follow each other and
     *  differ by one item at most. */
    struct Block {
        uint64_t first, last;
        bool operator==(const Block&) const = default;
    };
    Block block(uint64_t total) const;
    /** Why `text` is no shard; empty: it is one. For CLI::Option::check. */
    static std::string refuse(const std::string& text);

    bool operator==(const Shard&) const = default;
};

}  // namespace insonify::command
