#pragma once
// What a log holds, whatever its format.
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "types/Samples.hpp"

namespace insonify::log {

/** Keys and values that a stream carries. */
using Metadata = std::map<std::string, std::string>;

/** What a log declares of one stream, and what it holds of it. */
struct Stream {
    std::string name;                ///< "task.port".
    std::string type;                ///< Rock's name of its samples; of a type that is not known, the log's own.
    std::optional<size_t> sample{};  ///< Place of the type in types::SampleTypes; none: it is not known.
    Metadata metadata{};
    size_t count = 0;             ///< Samples [1].
    types::Time first{}, last{};  ///< World time of its first and last sample, 0 without samples.
    std::string topic{};          ///< Of its messages, "/auv/sonar"; empty in a log that has none.

    /** Whether its samples are of T. */
    template <class T>
    bool holds() const {
        return sample == types::sampleIndex<T>();
    }
    /** Mean rate between the first sample and the last; 0 where there is none [Hz]. */
    double rate() const {
        const double span = (last - first).seconds();
        return span > 0 ? static_cast<double>(count - 1) / span : 0;
    }
    /** Of its metadata; empty where it is not there. */
    std::string metadatum(const std::string& key) const {
        const auto found = metadata.find(key);
        return found == metadata.end() ? "" : found->second;
    }
};

/** Where one sample stands in a log. */
struct SampleRef {
    size_t stream = 0;       ///< Index into Reader::streams().
    types::Time received{};  ///< When it was logged.
    types::Time time{};      ///< When it was true in the world.
    uint64_t position = 0;   ///< Of its bytes in the file, or of what is compressed and holds it [B].
    size_t number = 0;       ///< Its place in Reader::samples() [1].
};

/** A part of a file that is no log. */
struct Gap {
    uint64_t from = 0, to = 0;  ///< [B]
    uint64_t byte = 0;          ///< The first that is wrong [B].
    std::string what;           ///< What is wrong with it.
};

/** Adds a gap; one that begins where the last ends makes that longer. */
inline void addGap(std::vector<Gap>& gaps, Gap gap) {
    if (!gaps.empty() && gaps.back().to == gap.from)
        gaps.back().to = gap.to;
    else
        gaps.push_back(std::move(gap));
}

/** What is done where a file goes on with something that cannot be: read no further, or look for what goes on. */
enum class AtDamage { Stop, Skip };

/** Bytes that are not what they must be: the first of them, counted from the beginning of the file or of the buffer
 *  that was read, and why. */
struct FormatError : std::runtime_error {
    FormatError(uint64_t at, const std::string& what) : std::runtime_error(what), byte(at) {}
    uint64_t byte;
};

/** "2026-11-22 12:55:44.500000" (UTC) of a time of this century, "2.500000 s" of one that counts from a start. */
std::string readable(types::Time time);

/** The reverse: such a date, down to the second or finer, or the seconds after `start`. Throws ConfigError that names
 *  `what`. */
types::Time readTime(const std::string& text, const std::string& what, types::Time start = {});

}  // namespace insonify::log
