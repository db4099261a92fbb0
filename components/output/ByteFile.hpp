#pragma once
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace insonify::output {

/** Writes a file on a separate thread, so that callers do not wait for the disk, unless it is slower than they are for
 *  long. */
class ByteFile {
public:
    static constexpr size_t max_waiting = size_t{64} << 20;  ///< Bytes that wait, apart from one call's [B].

    /** Throws ConfigError if the file cannot be created. */
    explicit ByteFile(const std::filesystem::path& path);
    ~ByteFile();  ///< Writes the queue; errors are no longer reported.
    ByteFile(const ByteFile&) = delete;
    ByteFile& operator=(const ByteFile&) = delete;

    /** Appends bytes; waits while max_waiting of them wait. Throws if earlier bytes could not be written. */
    void append(const std::vector<char>& bytes);
    /** The same, but returns false at once where append() would wait. */
    bool tryAppend(const std::vector<char>& bytes);
    /** Writes the queue and closes the file. Throws std::runtime_error if some bytes could not be written. */
    void close();

private:
    bool hasRoom(size_t bytes) const { return waiting_.empty() || waiting_.size() + bytes <= max_waiting; }
    void queue(const std::vector<char>& bytes);
    void throwAny() const;
    void write(const char* data, size_t size);
    void loop();
    void end();

    std::filesystem::path path_;
    int file_ = -1;
    std::mutex mutex_;
    std::condition_variable changed_, written_;
    std::vector<char> waiting_, writing_;
    bool ending_ = false;
    int failure_ = 0;  ///< Number of the first error of the system; 0: none.
    std::thread thread_;
};

}  // namespace insonify::output
