#include "components/output/ByteFile.hpp"

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "types/ConfigError.hpp"

namespace insonify::output {

ByteFile::ByteFile(const std::filesystem::path& path) : path_(path) {
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
    file_.open(path, std::ios::binary | std::ios::trunc);
    if (!file_)
        throw types::ConfigError(path.string(), "", "cannot be written: " + std::generic_category().message(errno));
    thread_ = std::thread(&ByteFile::loop, this);
}

ByteFile::~ByteFile() { end(); }

void ByteFile::append(const std::vector<char>& bytes) {
    {
        std::lock_guard lock(mutex_);
        if (failed_) throw std::runtime_error(path_.string() + ": cannot be written: the disk may be full");
        waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
    }
    changed_.notify_one();
}

void ByteFile::close() {
    end();
    file_.close();
    if (failed_ || !file_) throw std::runtime_error(path_.string() + ": cannot be written: the disk may be full");
}

void ByteFile::end() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
}

void ByteFile::loop() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        std::swap(waiting_, writing_);
        lock.unlock();
        file_.write(writing_.data(), static_cast<std::streamsize>(writing_.size()));
        file_.flush();
        writing_.clear();
        lock.lock();
        failed_ = failed_ || !file_;
    }
}

}  // namespace insonify::output
