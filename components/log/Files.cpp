#include "components/log/Files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <mutex>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "components/log/Reader.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::log {

Verdict check(const std::filesystem::path& path) {
    if (getStorage(path) == Storage::Pocolog && !std::filesystem::is_directory(path)) return pocolog::check(path);
    const auto log = openLog(path);
    Verdict verdict{log->streams().size(), 0, 0, {}};
    for (const Stream& stream : log->streams()) verdict.set_backs += stream.set_backs;
    for (const SampleRef& at : log->samples()) {
        try {
            log->verify(at);
        } catch (const types::ConfigError& error) {
            verdict.diagnostic = {path, at.position, error.diagnostics().front().message};
            return verdict;
        }
        ++verdict.samples;
    }
    if (!log->complete()) verdict.diagnostic = {path, log->gaps().front().byte, log->gaps().front().what};
    return verdict;
}

namespace {

std::string reason(int error_number) { return std::generic_category().message(error_number); }

/** The files that this process reads, by device and number: a run that reads a log must not empty it. */
class Inputs {
public:
    using File = std::pair<uint64_t, uint64_t>;
    void add(const File& file) {
        const std::lock_guard lock(mutex_);
        files_.insert(file);
    }
    void remove(const File& file) {
        const std::lock_guard lock(mutex_);
        files_.erase(files_.find(file));
    }
    bool has(const struct stat& status) {
        const std::lock_guard lock(mutex_);
        return files_.contains({status.st_dev, status.st_ino});
    }

private:
    std::mutex mutex_;
    std::multiset<File> files_;
};

Inputs& inputs() {
    static Inputs all;
    return all;
}

/** Whether another open file has locked the log; locks it if not. */
bool isTaken(int file) { return flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK; }

}  // namespace

InputFile::InputFile(const std::filesystem::path& path) {
    file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file_ < 0) throw types::ConfigError(path, "", "cannot be read: " + std::generic_category().message(errno));
    struct stat status {};
    if (fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) {
        ::close(file_);
        throw types::ConfigError(
            path, "",
            S_ISDIR(status.st_mode) ? "is a folder; give a log in it: a " + logEndings() + " file" : "is not a file");
    }
    size_ = static_cast<uint64_t>(status.st_size);
    identity_ = {status.st_dev, status.st_ino};
    inputs().add(identity_);
}

InputFile::~InputFile() {
    inputs().remove(identity_);
    ::close(file_);
}

bool InputFile::read(uint64_t position, void* to, size_t size) const {
    char* next = static_cast<char*>(to);
    while (size > 0) {
        const ssize_t got = pread(file_, next, size, static_cast<off_t>(position));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        next += got;
        position += static_cast<uint64_t>(got);
        size -= static_cast<size_t>(got);
    }
    return true;
}

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
    file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    created_ = file_ >= 0;
    if (file_ < 0 && errno == EEXIST) file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0) throw types::ConfigError(path_, "", "the log cannot be written: " + reason(errno));
    struct stat status {};
    const bool is_file = fstat(file_, &status) == 0 && S_ISREG(status.st_mode);
    const bool taken = is_file && isTaken(file_);  // a device such as /dev/null may be shared
    const bool is_read = is_file && inputs().has(status);
    if (!taken && !is_read) return;
    ::close(std::exchange(file_, -1));
    throw types::ConfigError(
        path_, "",
        std::string("the log cannot be written: ") +
            (taken ? "another logger writes it" : "it is the log that is read; give another file"));
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, -1)),
      syncs_(other.syncs_),
      created_(other.created_),
      begun_(other.begun_),
      size_(other.size_) {}

OutputFile::~OutputFile() {
    if (file_ < 0) return;
    if (created_ && !begun_) ::unlink(path_.c_str());
    ::close(file_);
}

void OutputFile::append(const char* data, size_t size) {
    if (!std::exchange(begun_, true) && ftruncate(file_, 0) != 0 && errno != EINVAL) fail(errno);  // EINVAL: a device
    const uint64_t whole = size_ + size;
    while (size > 0) {
        const ssize_t written = ::write(file_, data, size);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(errno);
        data += written;
        size -= static_cast<size_t>(written);
    }
    size_ = whole;
}

void OutputFile::fail(int error_number) {
    // An incomplete block at the end would stop Rock's Ruby reader: truncate to the last complete one. A device cannot
    // be truncated.
    [[maybe_unused]] const int cut = ftruncate(file_, static_cast<off_t>(size_));
    ::close(std::exchange(file_, -1));
    throw std::runtime_error(path_.string() + ": the log cannot be written: " + reason(error_number));
}

void OutputFile::sync() {
    syncs_ = true;
    if (fdatasync(file_) != 0 && errno != EINVAL && errno != EROFS) fail(errno);  // a device need not have it
}

void OutputFile::close() {
    if (syncs_) sync();
    if (::close(std::exchange(file_, -1)) != 0)
        throw std::runtime_error(path_.string() + ": the log cannot be written: " + reason(errno));
}

bool isBeingWritten(const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return false;
    const bool taken = isTaken(file);
    ::close(file);
    return taken;
}

bool removeLog(const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return false;
    const bool taken = isTaken(file);
    std::error_code failed;
    const bool removed = !taken && std::filesystem::remove(path, failed);
    if (removed) std::filesystem::remove(pocolog::indexPath(path), failed);
    ::close(file);
    if (taken) throw types::ConfigError(path, "", "the log cannot be removed: another logger writes it");
    return removed;
}

}  // namespace insonify::log
