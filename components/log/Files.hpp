#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace insonify::log {

/** The first wrong byte of a file. */
struct Diagnostic {
    std::filesystem::path file;  ///< The log, or its index.
    uint64_t byte = 0;           ///< From the beginning of the file [B].
    std::string message;         ///< What the byte is, and what it may be.
};

/** The result of a strict reader. */
struct Verdict {
    size_t streams = 0, samples = 0;  ///< Before the wrong byte.
    size_t set_backs = 0;             ///< Steps back of streams' times by more than types::max_lateness.
    std::optional<Diagnostic>
        diagnostic;  ///< None: for a pocolog file without set_backs, both of Rock's readers accept it.
};

/** Reads a log strictly: a pocolog file as pocolog::check, an MCAP file with each record, checksum, index and message.
 *  Throws ConfigError when the file cannot be read. */
Verdict check(const std::filesystem::path& path);

namespace pocolog {

/** Reads a log as strictly as Rock's strictest reader, and checks what Rock's readers skip as well: the prologue; order
 *  and sizes of blocks; declarations (numbers in order, unique names, a registry with the type, flat metadata); times
 *  in order except where the clock was set back; samples of known types to the last byte; and the index next to the
 * log, if there is one, except the modification time in it. Throws ConfigError when the file cannot be read. */
Verdict check(const std::filesystem::path& path);

}  // namespace pocolog

/** A file open for reading. Positions are in bytes from its beginning. */
class InputFile {
public:
    /** Throws ConfigError when the path cannot be read or is not a file. */
    explicit InputFile(const std::filesystem::path& path);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    uint64_t size() const { return size_; }
    /** False at the end of the file or on an error of the system. */
    bool read(uint64_t position, void* to, size_t size) const;

private:
    int file_ = -1;
    uint64_t size_ = 0;
    std::pair<uint64_t, uint64_t> identity_;  ///< Device and number of the file.
};

/** A log that is being written, by one writer at a time and without incomplete writes. */
class OutputFile {
public:
    /** Takes the name: creates the file, or leaves one that is there as it is until the first append(). Throws
     *  ConfigError when this fails, when another OutputFile, of any process, has it open, or an InputFile of this
     *  process. */
    explicit OutputFile(std::filesystem::path path);
    ~OutputFile();  ///< Removes a file that it has created and to which nothing was appended.
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    OutputFile(OutputFile&& other) noexcept;

    /** Writes all bytes, the first to an emptied file. On failure, throws std::runtime_error with the system's reason;
     * the file is truncated to its previous end and closed. */
    void append(const char* data, size_t size);
    /** Waits until all bytes are on the disk. From then on, close() does as well. Throws as append(). */
    void sync();
    bool syncs() const { return syncs_; }
    /** Throws std::runtime_error with the system's reason. */
    void close();
    bool isOpen() const { return file_ >= 0; }
    uint64_t size() const { return size_; }  ///< [B]

private:
    [[noreturn]] void fail(int error_number);

    std::filesystem::path path_;
    int file_ = -1;
    bool syncs_ = false;
    bool created_ = false, begun_ = false;
    uint64_t size_ = 0;
};

/** Whether a Writer of any process has this log open. */
bool isBeingWritten(const std::filesystem::path& path);

/** Removes a log and its index; false: there is none, or it cannot be removed. Throws ConfigError when a Writer of any
 *  process has it open. */
bool removeLog(const std::filesystem::path& path);

}  // namespace insonify::log
