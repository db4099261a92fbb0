#pragma once
// The contents of a log, independent of its format.
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "types/samples/Samples.hpp"

namespace insonify::log {

/** The keys and values of a stream. */
using Metadata = std::map<std::string, std::string>;

/** A log's declaration of one stream, and its contents. */
struct Stream {
    std::string name;                ///< "task.port".
    std::string type;                ///< Rock's name of its samples' type; for an unknown type, the log's own.
    std::optional<size_t> sample{};  ///< Index of the type in types::SampleTypes; none: unknown.
    Metadata metadata{};
    size_t count = 0;             ///< Samples [1].
    types::Time first{}, last{};  ///< World time of its first and last sample, 0 without samples.
    types::Time set_back{};       ///< By how much its times went back, in all steps of more than types::max_lateness.
    size_t set_backs = 0;         ///< Number of these steps: the clock was set back [1].
    std::string topic{};          ///< Topic of its messages, "/auv/sonar"; empty in logs without topics.
    std::string message{};        ///< Type of its messages in CDR, "nav_msgs/msg/Odometry"; empty: it has no such.

    /** Whether its samples have type T. */
    template <class T>
    bool holds() const {
        return sample == types::sampleIndex<T>();
    }
    /** Returns the mean rate between the first sample and the last, where steps back take no time; 0: undefined [Hz].
     */
    double rate() const {
        const double span = (last - first + set_back).seconds();
        return span > 0 ? static_cast<double>(count - 1) / span : 0;
    }
    /** Adds a sample of this world time to its count, span and steps. */
    void note(types::Time time);
    /** Returns a metadatum of the stream; empty: there is none. */
    std::string metadatum(const std::string& key) const {
        const auto found = metadata.find(key);
        return found == metadata.end() ? "" : found->second;
    }
};

constexpr const char *objects_key = "insonify_objects", *bin_width_key = "insonify_bin_width",
                     *speed_of_sound_key = "insonify_speed_of_sound";

/** Adds what the first sample of a stream states for all of its samples: the names of objects as a JSON list
 *  (`insonify_objects`), and for bins that are not whole microseconds their exact width [m] and the speed of sound in
 *  the water [m/s] (`insonify_bin_width`, `insonify_speed_of_sound`). The samples of such a stream contain the speed of
 *  sound with which bin_duration is the width, see types::RangeBins. */
void addSampleMetadata(types::SampleView first, Metadata& metadata);

/** Restores the exact width of bins and the speed of sound in the water from a stream's metadata, if they are those of
 *  the sample. */
void restoreBins(const Metadata& metadata, types::SampleRoom sample);

/** The place of one sample in a log. */
struct SampleRef {
    size_t stream = 0;       ///< Index into Reader::streams().
    types::Time received{};  ///< When it was logged.
    types::Time time{};      ///< When it was true in the world.
    uint64_t position = 0;   ///< Position of its bytes in the file, or of the compressed block around it [B].
    size_t number = 0;       ///< Its place among the samples of the file, from 0; a made pose has that of its message.
};

/** A part of a file that is not readable as a log. */
struct Gap {
    uint64_t from = 0, to = 0;  ///< [B]
    uint64_t byte = 0;          ///< The first wrong byte [B].
    std::string what;           ///< What is wrong with it.
};

/** Adds a gap; a gap that begins where the last one ends extends it. */
inline void addGap(std::vector<Gap>& gaps, Gap gap) {
    if (!gaps.empty() && gaps.back().to == gap.from)
        gaps.back().to = gap.to;
    else
        gaps.push_back(std::move(gap));
}

/** What to do at damage: stop reading, or search for the next readable part. */
enum class AtDamage { Stop, Skip };

/** Invalid bytes: the position of the first, from the beginning of the file or buffer, and the reason. */
struct FormatError : std::runtime_error {
    FormatError(uint64_t at, const std::string& what) : std::runtime_error(what), byte(at) {}
    uint64_t byte;
};

/** Returns "2026-11-22 12:55:44.500000" (UTC) for a time of this century, "2.500000 s" for a time since a start. */
std::string readable(types::Time time);
bool hasDate(types::Time time);  ///< Whether readable() is a date.

/** Parses a date of that form, to the second or finer, or seconds after `start`. Throws ConfigError that names
 *  `what`. */
types::Time readTime(const std::string& text, const std::string& what, types::Time start = {});

}  // namespace insonify::log
