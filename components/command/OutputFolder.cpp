#include "components/command/OutputFolder.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <unistd.h>

#include <ctime>

#include "types/ConfigError.hpp"

namespace insonify::command {
namespace fs = std::filesystem;
namespace {

/** Returns out/<deployment>-<UTC time>, with a number if two runs start within a second. */
fs::path freshFolder(const fs::path& deployment) {
    const std::string name =
        fmt::format("{}-{:%Y%m%dT%H%M%SZ}", deployment.stem().string(), fmt::gmtime(std::time(nullptr)));
    fs::path folder = fs::path("out") / name;
    for (int i = 2; fs::exists(folder); ++i) folder = fs::path("out") / fmt::format("{}-{}", name, i);
    return folder;
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
    : path_(asked.empty() ? freshFolder(deployment) : fs::path(asked)), asked_(!asked.empty()) {
    std::error_code error;
    made_ = fs::create_directories(path_, error);
    if (error || !fs::is_directory(path_))
        throw types::ConfigError(path_, "--out", fmt::format("is no folder and cannot be made: {}", error.message()));
    if (::access(path_.c_str(), W_OK | X_OK) != 0)
        throw types::ConfigError(path_, "--out", "cannot be written to; give a writable folder");
    had_files_ = !made_ && !fs::is_empty(path_, error);
}

void OutputFolder::keep() {
    kept_ = true;
    if (!asked_) linkLatest(path_);
}

OutputFolder::~OutputFolder() {
    std::error_code ignored;
    if (made_ && !kept_) fs::remove_all(path_, ignored);
}

}  // namespace insonify::command
