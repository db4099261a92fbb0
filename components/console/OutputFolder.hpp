#pragma once
#include <filesystem>
#include <string>

namespace insonify::console {

/** The folder of a run's files. Unless keep() is called, a folder that this object has made is removed with it if it
 *  holds no file and no other run uses it. Files are never removed: they may be those of another run. */
class OutputFolder {
public:
    /** `asked` is `--out`; empty: out/<deployment>-<UTC time> in the current folder. Throws types::ConfigError when the
     *  folder cannot be made or written to. */
    OutputFolder(const std::string& asked, const std::filesystem::path& deployment);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    /** Returns whether the folder had files before the run. */
    bool hadFiles() const { return had_files_; }
    /** Keeps the folder, once the run has started. If `asked` was empty, the link out/latest points to the folder. */
    void keep();

private:
    void leave();

    std::filesystem::path path_;
    int file_ = -1;  ///< The open folder, with a shared lock while a run uses it.
    bool made_ = false, asked_, kept_ = false, had_files_ = false;
};

}  // namespace insonify::console
