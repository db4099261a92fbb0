#pragma once
#include <filesystem>
#include <string>

namespace insonify::command {

/** Where a run leaves its files. Unless it is kept, a folder that was made for the run goes with this object. */
class OutputFolder {
public:
    /** `asked` is `--out`; empty: out/<deployment>-<UTC time> in the current folder.
     *  Throws types::ConfigError when it cannot be made or written to. */
    OutputFolder(const std::string& asked, const std::filesystem::path& deployment);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    /** The run has started: the folder stays, and where none was asked for the link out/latest leads to it. */
    void keep();

private:
    std::filesystem::path path_;
    bool made_ = false, asked_, kept_ = false;
};

}  // namespace insonify::command
