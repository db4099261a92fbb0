#include "components/console/OutputFolder.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <system_error>
#include <utility>
#include <vector>

#include "types/text/ConfigError.hpp"

namespace insonify::console {
namespace fs = std::filesystem;
namespace {

/** Returns `out` for `out/`. */
fs::path withoutSlash(const fs::path& folder) { return folder.has_filename() ? folder : folder.parent_path(); }

/** Returns the error of making a folder whose parents are made if necessary; EEXIST: it is there. */
int make(const fs::path& folder) {
    std::error_code error;
    if (folder.has_parent_path()) fs::create_directories(folder.parent_path(), error);
    if (error) return error.value();
    return ::mkdir(folder.c_str(), 0777) == 0 ? 0 : errno;
}

/** Makes out/<deployment>-<UTC time>, with a number if other runs have made that name. */
fs::path makeFresh(const fs::path& deployment, int& error) {
    const std::string name =
        fmt::format("{}-{:%Y%m%dT%H%M%SZ}", deployment.stem().string(), fmt::gmtime(std::time(nullptr)));
    fs::path folder = fs::path("out") / name;
    error = make(folder);
    for (int i = 2; error == EEXIST; ++i) {
        folder = fs::path("out") / fmt::format("{}-{}", name, i);
        error = make(folder);
    }
    return folder;
}

/** Whether an open folder still has this name. */
bool isAt(int file, const fs::path& path) {
    struct stat open {};
    struct stat named {};
    return fstat(file, &open) == 0 && stat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
           open.st_ino == named.st_ino;
}

/** Removes a folder with its folders if none holds a file. */
void removeEmpty(const fs::path& folder) noexcept try {
    std::error_code ignored;
    std::vector<fs::path> folders{folder};
    for (const auto& entry : fs::recursive_directory_iterator(folder, ignored))
        if (entry.symlink_status(ignored).type() == fs::file_type::directory) folders.push_back(entry.path());
    for (; !folders.empty(); folders.pop_back()) ::rmdir(folders.back().c_str());  // the innermost are last
} catch (const std::exception&) {
    // It stays.
}

/** Makes the link if possible; a failure is ignored. */
void linkLatest(const fs::path& folder) {
    std::error_code ignored;
    const fs::path link = folder.parent_path() / "latest";
    if (fs::is_symlink(link, ignored)) fs::remove(link, ignored);
    fs::create_directory_symlink(folder.filename(), link, ignored);
}

}  // namespace

OutputFolder::OutputFolder(const std::string& asked, const fs::path& deployment)
    : path_(withoutSlash(asked)), asked_(!asked.empty()) {
    constexpr int max_tries = 100;  // another run may remove the folder that it has made
    int error = 0;
    for (int attempt = 0; file_ < 0 && attempt < max_tries; ++attempt) {
        if (asked_)
            error = make(path_);
        else
            path_ = makeFresh(deployment, error);
        made_ = error == 0;
        if (error != 0 && error != EEXIST) break;
        file_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        error = file_ < 0 ? errno : 0;
        if (file_ < 0 && error != ENOENT) break;
        if (file_ < 0) continue;
        ::flock(file_, LOCK_SH | LOCK_NB);  // where there are no locks, nothing is removed
        if (!isAt(file_, path_)) ::close(std::exchange(file_, -1));
    }
    std::error_code unknown;
    if (!fs::is_directory(path_, unknown))
        throw types::ConfigError(
            path_, "--out", fmt::format("is no folder and cannot be made: {}", std::generic_category().message(error)));
    if (::access(path_.c_str(), W_OK | X_OK) != 0) {
        leave();
        throw types::ConfigError(path_, "--out", "cannot be written to; give a writable folder");
    }
    had_files_ = !made_ && !fs::is_empty(path_, unknown);
}

void OutputFolder::keep() {
    kept_ = true;
    if (!asked_) linkLatest(path_);
}

void OutputFolder::leave() {
    if (file_ < 0) return;
    if (made_ && !kept_ && ::flock(file_, LOCK_EX | LOCK_NB) == 0) removeEmpty(path_);
    ::close(std::exchange(file_, -1));
}

OutputFolder::~OutputFolder() { leave(); }

}  // namespace insonify::console
