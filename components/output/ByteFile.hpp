#pragma once
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>
#include <vector>

namespace insonify::output {

/** A file that a thread of its own writes, so that who gives bytes waits for no disk. */
class ByteFile {
public:
    /** Throws ConfigError where the file cannot be made. */
    explicit ByteFile(const std::filesystem::path& path);
    ~ByteFile();  ///< Writes what waits; errors are not told any more.
    ByteFile(const ByteFile&) = delete;
    ByteFile& operator=(const ByteFile&) = delete;

    /** Throws what earlier bytes met. */
    void append(const std::vector<char>& bytes);
    /** Writes what waits and closes. Throws std::runtime_error when not all of it arrived. */
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
