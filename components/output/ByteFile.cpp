#include "components/output/ByteFile.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "types/Thread.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::output {

ByteFile::ByteFile(const std::filesystem::path& path) : path_(path) {
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
    file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file_ < 0)
        throw types::ConfigError(path.string(), "", "cannot be written: " + std::generic_category().message(errno));
    try {
        thread_ = types::startThread(path.string(), [this] { loop(); });
    } catch (...) {
        ::close(file_);
        throw;
    }
}

ByteFile::~ByteFile() {
    end();
    if (file_ >= 0) ::close(file_);
}

void ByteFile::throwAny() const {
    if (failure_ != 0)
        throw std::runtime_error(path_.string() + ": cannot be written: " + std::generic_category().message(failure_));
}

void ByteFile::queue(const std::vector<char>& bytes) {
    throwAny();
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
    changed_.notify_one();
}

void ByteFile::append(const std::vector<char>& bytes) {
    std::unique_lock lock(mutex_);
    written_.wait(lock, [&] { return hasRoom(bytes.size()) || failure_ != 0; });
    queue(bytes);
}

bool ByteFile::tryAppend(const std::vector<char>& bytes) {
    std::lock_guard lock(mutex_);
    if (!hasRoom(bytes.size()) && failure_ == 0) return false;
    queue(bytes);
    return true;
}

void ByteFile::close() {
    end();
    if (::close(std::exchange(file_, -1)) != 0 && failure_ == 0) failure_ = errno;
    throwAny();
}

void ByteFile::end() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
}

void ByteFile::write(const char* data, size_t size) {
    while (size > 0 && failure_ == 0) {
        const ssize_t written = ::write(file_, data, size);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            const std::lock_guard lock(mutex_);
            failure_ = errno;
            return;
        }
        data += written;
        size -= static_cast<size_t>(written);
    }
}

void ByteFile::loop() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        std::swap(waiting_, writing_);
        lock.unlock();
        written_.notify_all();
        write(writing_.data(), writing_.size());
        writing_.clear();
        lock.lock();
        written_.notify_all();
    }
}

}  // namespace insonify::output
