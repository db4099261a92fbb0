#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "components/pocolog/Metadata.hpp"
#include "components/pocolog/Typelib.hpp"
#include "components/pocolog/Wire.hpp"
#include "types/ConfigError.hpp"
#include "types/Time.hpp"

namespace insonify::pocolog {

/** What a log declares of one stream, and what it holds of it. */
struct Stream {
    std::string name;      ///< "task.port".
    std::string type;      ///< Typelib name; this program may not know it.
    std::string registry;  ///< XML.
    Metadata metadata;
    size_t count = 0;         ///< Samples [1].
    types::Time first, last;  ///< World time of its first and last sample, 0 without samples.

    /** Whether its samples can be read as T. */
    template <class T>
    bool holds() const {
        return type == typelibName<T>() || type == cxxName<T>();
    }
};

/** Where one sample stands in the file. */
struct SampleRef {
    size_t stream = 0;      ///< Index into Reader::streams().
    types::Time received;   ///< When it was logged.
    types::Time time;       ///< When it was true in the world.
    uint64_t position = 0;  ///< Of its bytes in the file [B].
    uint32_t size = 0;      ///< Of its bytes in the file [B].
    bool compressed = false;
    uint32_t offset = 0;  ///< In what is compressed there, where many samples are so together [B].
};

/** A part of a file that is no log. */
struct Gap {
    uint64_t from = 0, to = 0;  ///< [B]
    uint64_t byte = 0;          ///< The first that is wrong [B].
    std::string what;           ///< What is wrong with it.
};

/** What is done where a file goes on with something that is no block: read no further, or look for the next block. */
enum class AtDamage { Stop, Skip };

class BlockFile;

/** A log in another format, read as if it were a pocolog file. */
struct Source {
    virtual ~Source() = default;
    /** Fills `to` with the bytes of one sample as typelib marshals them. Throws std::runtime_error where the file holds
     *  no such sample. */
    virtual void read(const SampleRef& at, std::vector<char>& to) = 0;

    uint64_t bytes = 0;  ///< Size of the file [B].
    std::vector<Stream> streams;
    std::vector<SampleRef> samples;
    std::vector<Gap> gaps;
};

/** Reads a pocolog v2 file, ours or Rock's: an index in memory, samples from the file when asked for.
 *
 *      Reader log("harbour.0.log");
 *      log.forEach<types::Sonar>("sonar.ping", [&](const types::Sonar& ping, const SampleRef& at) { ... });
 *
 *  A file that ends within a block, or goes on with something that is no block, is read up to there: complete() is
 *  false and fault() says why. What is no log at all throws ConfigError, as do samples that cannot be decoded. */
class Reader {
public:
    explicit Reader(std::filesystem::path path, AtDamage at_damage = AtDamage::Stop);
    Reader(std::filesystem::path path, std::unique_ptr<Source> source);
    ~Reader();
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    const std::filesystem::path& path() const { return path_; }
    uint64_t bytes() const;  ///< Size of the file [B].
    bool complete() const { return gaps_.empty(); }
    std::string fault() const;                              ///< Why and where reading stopped; empty: it did not.
    const std::vector<Gap>& gaps() const { return gaps_; }  ///< What was not read, in file order.
    const std::vector<Stream>& streams() const { return streams_; }
    const std::vector<SampleRef>& samples() const { return samples_; }  ///< Of all streams, in file order.
    const Stream* find(const std::string& name) const;                  ///< Null when there is none.
    /** Index of a stream; throws ConfigError that lists the streams when there is none. */
    size_t indexOf(const std::string& name) const;

    /** Decodes one sample into `sample`, whose memory is used again. */
    template <class T>
    void read(const SampleRef& at, T& sample) {
        if (!streams_[at.stream].holds<T>()) failType(at, typelibName<T>());
        try {
            unmarshal(bytesOf(at), sample);
        } catch (const WireError& error) {
            failSample(at, error.what());
        }
    }
    /** The bytes of one sample, decompressed; good until the next call. */
    std::span<const char> bytesOf(const SampleRef& at);
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

private:
    [[noreturn]] void failSample(const SampleRef& at, const std::string& what) const;
    [[noreturn]] void failType(const SampleRef& at, const std::string& wanted) const;

    std::filesystem::path path_;
    std::unique_ptr<BlockFile> file_;  ///< Or:
    std::unique_ptr<Source> source_;
    std::vector<Stream> streams_;
    std::vector<SampleRef> samples_;
    std::vector<Gap> gaps_;
    std::vector<char> buffer_, inflated_;
};

}  // namespace insonify::pocolog
