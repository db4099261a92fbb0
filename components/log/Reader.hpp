#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "components/log/Stream.hpp"
#include "types/ConfigError.hpp"

namespace insonify::log {

/** Reads a log of either format: an index in memory, samples from the file when asked for.
 *
 *      const auto log = openLog("harbour.0.log");
 *      log->forEach<types::Sonar>("sonar.ping", [&](const types::Sonar& ping, const SampleRef& at) { ... });
 *
 *  A file that ends too early, or goes on with something that cannot be, is read up to there: complete() is false and
 *  diagnostic() says why. What is no log at all throws ConfigError, as do samples that cannot be decoded. */
class Reader {
public:
    virtual ~Reader() = default;
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    const std::filesystem::path& path() const { return path_; }
    virtual uint64_t bytes() const = 0;  ///< Size of the file [B].
    bool complete() const { return gaps_.empty(); }
    std::string diagnostic() const;                         ///< Why and where reading stopped; empty: it did not.
    const std::vector<Gap>& gaps() const { return gaps_; }  ///< What was not read, in file order.
    const std::vector<Stream>& streams() const { return streams_; }
    const std::vector<SampleRef>& samples() const { return samples_; }  ///< Of all streams, in file order.
    /** By its name, or else its topic, or else as "/task/port"; null when there is none. */
    const Stream* find(const std::string& name) const;
    /** Index of a stream; throws ConfigError that lists the streams when there is none. */
    size_t indexOf(const std::string& name) const;
    /** Of the first stream that has this key; empty: none has. */
    std::string metadatum(const std::string& key) const;

    /** Decodes one sample into `sample`, whose memory is used again. Throws ConfigError for a sample of another type
     *  and for one that cannot be decoded. */
    template <class T>
    void read(const SampleRef& at, T& sample) {
        if (!streams_[at.stream].holds<T>()) failType(at, types::sampleIndex<T>());
        readInto(at, &sample);
    }
    /** Decodes a sample of a known type; it is good until the next call. Throws as read(). */
    types::SampleView sampleAt(const SampleRef& at);
    /** Throws ConfigError for a sample of a known type that cannot be decoded, or that contradicts itself. */
    void verify(const SampleRef& at);
    /** What a stream's samples look like, as the log declares it: typelib's registry, or a message's schema. */
    virtual const std::string& layout(size_t stream) const = 0;
    /** The bytes of one sample as the format has them, decompressed; good until the next call. */
    virtual std::span<const char> bytesOf(const SampleRef& at) = 0;

    /** Calls `use(sample, ref)` for each sample of the stream, in order; the sample is only lent. */
    template <class T, class Use>
    void forEach(const std::string& stream, Use&& use) {
        T sample{};
        forEachRef(stream, [&](const SampleRef& at) {
            read(at, sample);
            use(std::as_const(sample), at);
        });
    }
    /** Calls `use(ref)` for each sample of the stream, in order. */
    template <class Use>
    void forEachRef(const std::string& stream, Use&& use) const {
        const size_t index = indexOf(stream);
        for (const SampleRef& at : samples_)
            if (at.stream == index) use(at);
    }

protected:
    explicit Reader(std::filesystem::path path) : path_(std::move(path)) {}
    /** Decodes a sample into what its stream holds. Throws std::exception for what is none. */
    virtual void decode(const SampleRef& at, types::SampleRoom room) = 0;
    [[noreturn]] void failSample(const SampleRef& at, const std::string& what) const;

    /** Enlists a sample of a stream that is declared. */
    void addSample(size_t stream, types::Time received, types::Time time, uint64_t position);

    std::vector<Stream> streams_;
    std::vector<SampleRef> samples_;
    std::vector<Gap> gaps_;

private:
    void readInto(const SampleRef& at, types::SampleRoom room);
    [[noreturn]] void failType(const SampleRef& at, size_t wanted) const;

    std::filesystem::path path_;
    std::unique_ptr<types::SampleTypes> room_;  ///< To decode into.
};

/** A place for a sample of each type: the one at a place of types::SampleTypes. */
types::SampleRoom roomFor(size_t sample, types::SampleTypes& samples);

/** What of a sample contradicts itself, after "a sample"; null: nothing. */
const char* diagnosticOf(types::SampleView sample);

/** Whether a file is read and written as MCAP: by its name, *.mcap. */
bool isMcap(const std::filesystem::path& path);

/** Opens a log of either format, see pocolog::Reader and mcap::Reader. Throws ConfigError for what is no log. */
std::unique_ptr<Reader> openLog(const std::filesystem::path& path, AtDamage at_damage = AtDamage::Stop);

/** The log of properties that belongs to a log: properties.0.log beside it, when that is of the same run; none. */
std::optional<std::filesystem::path> propertyLogOf(const Reader& log);

/** Whether the stream holds pings, or the beams or scans that are read as such. */
bool holdsPings(const Stream& stream);

/** Fills `ping` from a sample of such a stream; a time that the sample does not give is that of its block. Throws
 *  ConfigError for one that contradicts itself. */
void readPing(Reader& log, const SampleRef& at, types::Sonar& ping);

}  // namespace insonify::log
