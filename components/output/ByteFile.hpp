#pragma once
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>
#include <vector>

namespace insonify::output {

/** Writes a file on a separate thread, so that callers do not wait for the disk. */
class ByteFile {
public:
    /** Throws ConfigError if the file cannot be created. */
    explicit ByteFile(const std::filesystem::path& path);
    ~ByteFile();  ///< Writes the queue; errors are no longer reported.
    ByteFile(const ByteFile&) = delete;
    ByteFile& operator=(const ByteFile&) = delete;

    /** Throws if earlier bytes could not be written. */
    void append(const std::vector<char>& bytes);
    /** Writes the queue and closes the file. Throws std::runtime_error if some bytes could not be written. */
    void close();

private:
    void loop();
    void end();

    std::filesystem::path path_;
    std::ofstream file_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<char> waiting_, writing_;
    bool ending_ = false, failed_ = false;
    std::thread thread_;
};

}  // namespace insonify::output
