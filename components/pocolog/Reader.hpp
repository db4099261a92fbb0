#pragma once
#include <filesystem>
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
    explicit Reader(std::filesystem::path path);
    ~Reader();
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    const std::filesystem::path& path() const { return path_; }
    uint64_t bytes() const { return bytes_; }  ///< Size of the file [B].
    bool complete() const { return fault_.empty(); }
    const std::string& fault() const { return fault_; }  ///< Why and where reading stopped; empty: it did not.
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
            unmarshal(payload(at), sample);
        } catch (const std::runtime_error& error) {
            failSample(at, error.what());
        }
    }
    /** Calls `use(sample, ref)` for each sample of the stream, in order; the sample is only lent. */
    template <class T, class Use>
    void forEach(const std::string& stream, Use&& use) {
        const size_t index = indexOf(stream);
        T sample{};
        for (const SampleRef& at : samples_)
            if (at.stream == index) {
                read(at, sample);
                use(std::as_const(sample), at);
            }
    }

private:
    std::span<const char> payload(const SampleRef& at);
    [[noreturn]] void failSample(const SampleRef& at, const std::string& what) const;
    [[noreturn]] void failType(const SampleRef& at, const std::string& wanted) const;

    std::filesystem::path path_;
    int file_ = -1;
    uint64_t bytes_ = 0;
    std::string fault_;
    std::vector<Stream> streams_;
    std::vector<SampleRef> samples_;
    std::vector<char> buffer_, inflated_;
};

}  // namespace insonify::pocolog
