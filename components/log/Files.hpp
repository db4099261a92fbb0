#pragma once
#include <cstdint>
#include <filesystem>
#include <utility>

namespace insonify::log {

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
    /** Throws std::runtime_error with the system's reason. */
    void close();
    bool isOpen() const { return file_ >= 0; }
    uint64_t size() const { return size_; }  ///< [B]

private:
    [[noreturn]] void fail(int error_number);

    std::filesystem::path path_;
    int file_ = -1;
    bool created_ = false, begun_ = false;
    uint64_t size_ = 0;
};

/** Whether a Writer of any process has this log open. */
bool isBeingWritten(const std::filesystem::path& path);

/** Removes a log and its index; false: there is none, or it cannot be removed. Throws ConfigError when a Writer of any
 *  process has it open. */
bool removeLog(const std::filesystem::path& path);

}  // namespace insonify::log
