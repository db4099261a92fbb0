#pragma once
#include <cstdint>
#include <filesystem>

namespace insonify::log {

/** An open file to read from. All positions are in bytes from its beginning. */
class InputFile {
public:
    /** Throws ConfigError when it cannot be read or is no file. */
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
};

/** A log that is being written: one writer at a time, nothing in it by halves. */
class OutputFile {
public:
    /** Creates the file, or empties it. Throws ConfigError when that cannot be done or another one, of this process or
     *  not, has it open. */
    explicit OutputFile(std::filesystem::path path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    OutputFile(OutputFile&& other) noexcept;

    /** Writes all of it. Otherwise throws std::runtime_error with the system's reason, and the file ends as it did
     *  before, and is closed. */
    void append(const char* data, size_t size);
    /** Throws std::runtime_error with the system's reason. */
    void close();
    bool isOpen() const { return file_ >= 0; }
    uint64_t size() const { return size_; }  ///< [B]

private:
    [[noreturn]] void fail(int error_number);

    std::filesystem::path path_;
    int file_ = -1;
    uint64_t size_ = 0;
};

/** Removes a log and its index; false: it is not there, or cannot be. Throws ConfigError when a Writer, of this process
 *  or not, has it open. */
bool removeLog(const std::filesystem::path& path);

}  // namespace insonify::log
