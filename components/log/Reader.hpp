#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "components/log/Stream.hpp"
#include "types/geometry/WorldFrame.hpp"

namespace insonify::log {

/** Reads a log of either format: keeps an index in memory, and reads samples from the file on request.
 *
 *      const auto log = openLog("harbour.0.log");
 *      log->forEach<types::Sonar>("sonar.ping", [&](const types::Sonar& ping, const SampleRef& at) { ... });
 *
 *  An incomplete or damaged file is read up to the damage: complete() is false and diagnostic() has the reason. A file
 *  that is not a log throws ConfigError, and so do samples that cannot be decoded. */
class Reader {
public:
    virtual ~Reader() = default;
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    const std::filesystem::path& path() const { return path_; }
    virtual uint64_t bytes() const = 0;  ///< Size of the file [B].
    bool complete() const { return gaps_.empty(); }
    std::string diagnostic() const;                         ///< Why and where reading stopped; empty: it did not.
    const std::vector<Gap>& gaps() const { return gaps_; }  ///< Skipped parts, in file order.
    const std::vector<Stream>& streams() const { return streams_; }
    const std::vector<SampleRef>& samples() const { return samples_; }  ///< Samples of all streams, in file order.
    /** Finds a stream by its name, its topic, or "/task/port"; null when there is none. */
    const Stream* find(const std::string& name) const;
    /** Returns the index of a stream. Throws ConfigError with the names of the streams when there is none. */
    size_t findIndex(const std::string& name) const;
    /** Returns the metadatum of the first stream that has this key; empty: there is none. */
    std::string metadatum(const std::string& key) const;

    /** A pose that follows from messages of the log, and the sample after which it is known. */
    struct MadePose {
        size_t after = 0;  ///< SampleRef::number.
        types::Time time{};
        glm::dvec3 position{0};
        glm::dquat orientation{1, 0, 0, 0};
        glm::dvec3 variances{types::Pose::unknown};  ///< Of the position [m^2].
    };
    struct MadePoses {
        std::string parent, child;    ///< Names of the frames.
        std::vector<MadePose> poses;  ///< At most one after a sample, in their order.
    };
    /** Adds a stream of poses that are not samples of the file. */
    void addPoses(Stream stream, MadePoses made);
    /** Keeps those samples of a stream for which `keep` returns true; it may change their times. */
    void keepSamples(size_t stream, const std::function<bool(SampleRef&)>& keep);
    /** Removes the samples of a stream that cannot be decoded or contradict themselves, and returns why, one text each.
     *  Throws ConfigError, as verify(), where no sample is left of them. */
    std::vector<std::string> dropDamaged(size_t stream);
    void rename(size_t stream, const std::string& name) { streams_[stream].name = name; }

    /** Decodes one sample into `sample`, reusing its memory. Throws ConfigError for a sample of another type or one
     *  that cannot be decoded. */
    template <class T>
    void read(const SampleRef& at, T& sample) {
        if (!streams_[at.stream].holds<T>()) failType(at, types::sampleIndex<T>());
        readInto(at, &sample);
    }
    /** Decodes a sample of a known type; valid until the next call. Throws as read(). */
    types::SampleView sampleAt(const SampleRef& at);
    /** Throws ConfigError for a sample of a known type that cannot be decoded, or that contradicts itself. */
    void verify(const SampleRef& at);
    /** Returns the declared layout of a stream's samples: typelib's registry, or a message's schema. */
    virtual const std::string& layout(size_t stream) const = 0;
    /** Returns the bytes of one sample in its format, decompressed; valid until the next call. */
    virtual std::span<const char> toBytes(const SampleRef& at) = 0;

    /** Calls `use(sample, ref)` for each sample of the stream, in order; the sample is valid only during the call. */
    template <class T, class Use>
    void forEach(const std::string& stream, Use&& use) {
        T sample{};
        forEachRef(stream, [&](const SampleRef& at) {
            read(at, sample);
            use(std::as_const(sample), at);
        });
    }
    /** Calls `use(ref)` for each sample of the stream, in order. */
    void forEachRef(const std::string& stream, auto&& use) const {
        const size_t index = findIndex(stream);
        for (const SampleRef& at : samples_)
            if (at.stream == index) use(at);
    }

protected:
    explicit Reader(std::filesystem::path path) : path_(std::move(path)) {}
    /** Decodes a sample of the stream's type. Throws std::exception for invalid bytes. */
    virtual void decode(const SampleRef& at, types::SampleRoom room) = 0;
    [[noreturn]] void failSample(const SampleRef& at, const std::string& what) const;
    /** Returns the place of a sample for messages: "at byte 120". */
    virtual std::string getPlace(const SampleRef& at) const { return "at byte " + std::to_string(at.position); }

    /** Adds a sample of a declared stream to the index. */
    void addSample(size_t stream, types::Time received, types::Time time, uint64_t position);

    std::vector<Stream> streams_;
    std::vector<SampleRef> samples_;
    std::vector<Gap> gaps_;

private:
    void readInto(const SampleRef& at, types::SampleRoom room);
    static void readMade(const SampleRef& at, const MadePoses& made, types::Pose& pose);
    [[noreturn]] void failType(const SampleRef& at, size_t wanted) const;

    std::filesystem::path path_;
    std::unique_ptr<types::SampleTypes> room_;  ///< Reused for decoding.
    std::map<size_t, MadePoses> made_;          ///< By stream, for those that are not in the file.
};

/** Returns the element of `samples` for the type with this index in types::SampleTypes. */
types::SampleRoom roomFor(size_t sample, types::SampleTypes& samples);

/** Returns how a sample contradicts itself, to follow "a sample"; null: it does not. */
const char* findDiagnostic(types::SampleView sample);

enum class Storage : uint8_t { Pocolog, Mcap, Db3 };

/** A format of logs. Its files are recognised by their ending, in any case of letters. */
struct LogFormat {
    std::string_view ending;  ///< In lower case: ".mcap".
    Storage storage = Storage::Pocolog;
    bool isWritten() const { return storage != Storage::Db3; }  ///< Others are only read.
};
/** Returns the format of a log that is written, by its name; null: it has no ending of one. Does not look at the
 *  file. */
const LogFormat* findLogFormat(const std::filesystem::path& path);
/** Returns the endings of the formats that are written, for a message: ".log or .mcap". */
std::string logEndings();
/** Returns the format of a file by its name; pocolog for other endings. */
Storage getStorage(const std::filesystem::path& path);
inline bool isMcap(const std::filesystem::path& path) { return getStorage(path) == Storage::Mcap; }

/** Opens a log of any format, see pocolog::Reader, mcap::Reader and db3::Reader, or the folder of a bag with all of its
 * files; a file with another ending is read as pocolog. Throws ConfigError for other files. @param foreign axes of
 * poses in messages of other programs */
std::unique_ptr<Reader> openLog(const std::filesystem::path& path, AtDamage at_damage = AtDamage::Stop,
                                types::WorldFrame foreign = types::WorldFrame::Enu);

// A log that is continued in several files, x.0.log, x.1.log and so on.
/** Returns a file's number in its sequence: 3 for x.3.log; none for x.log. */
std::optional<unsigned> sequenceNumber(const std::filesystem::path& log);
/** Returns the files of a log's sequence by their numbers, of which some may be missing; none for x.log. */
std::map<unsigned, std::filesystem::path> findSequence(const std::filesystem::path& log);

/** A log of one file or several. */
struct WholeLog {
    std::unique_ptr<Reader> log;
    std::vector<std::filesystem::path> files;  ///< In their order.
    std::string notice;                        ///< Which others were taken, and which are of another run; may be empty.
};
/** Opens a log as openLog() does. The first file of a sequence stands for all of them, as long as they are of the same
 *  run; its path is that of the log. Any other file is opened alone. */
WholeLog openWholeLog(const std::filesystem::path& path, AtDamage at_damage = AtDamage::Stop,
                      types::WorldFrame foreign = types::WorldFrame::Enu);

/** Returns the property log of a log: properties.0.log next to it, if it is from the same run; none: there is none. */
std::optional<std::filesystem::path> propertyLog(const Reader& log);

/** Whether the stream has pings, or beams or scans, which are read as pings. */
bool holdsPings(const Stream& stream);

/** Fills `ping` from a sample of a stream with holdsPings(). If the sample has no time, its block's time is used.
 *  Throws ConfigError for a sample that contradicts itself. */
void readPing(Reader& log, const SampleRef& at, types::Sonar& ping);

/** The times of a log whose logger's clock was set back while it ran, without these steps.
 *
 *  A step is where a sample was received more than types::max_lateness before the sample that precedes it in the log.
 *  The samples from there on are later by the step, and by the interval between the two samples before it. A sample
 *  stamped before the step and received after it stays where it is. Steps forward are not told from pauses. */
class LoggerClock {
public:
    LoggerClock() = default;
    /** @param samples of a log, in its order */
    explicit LoggerClock(const std::vector<SampleRef>& samples);

    /** Returns the world time of a sample of the log without the steps; its recorded time where there are none. */
    types::Time evenTime(const SampleRef& at) const;
    /** Returns the time from the first of these samples, all of the log, to one of them, without the steps. */
    types::Time sinceFirst(const std::vector<SampleRef>& samples, const SampleRef& at) const;
    /** Returns the time from the first of all samples to the latest, without the steps. */
    types::Time span(const std::vector<SampleRef>& samples) const;
    /** Returns the index of the first sample, in the log's order, at least this time after the first of all [s]; their
     *  number: there is none. */
    size_t indexAt(const std::vector<SampleRef>& samples, double seconds) const;

private:
    struct Step {
        size_t number = 0;  ///< Of the first sample after it [1].
        types::Time shift;  ///< Of the times after it: the sum of the steps up to there.
    };
    std::vector<Step> steps_{Step{}};
};

}  // namespace insonify::log
