#pragma once
#include <filesystem>
#include <optional>

#include "components/console/Json.hpp"
#include "components/console/Shard.hpp"

namespace insonify::deployer {

/** The folder of a shard's files: `shard_03_of_16` in a folder that all shards share, on any machine.
 *
 *  The files are written to a hidden temporary folder next to it. `manifest.json`, with the size and SHA-256 of each
 *  file, is written last; then the temporary folder is renamed. A folder with the final name is therefore complete,
 *  even after a crash. If two processes make the same shard, the first one is kept and the other leaves nothing. The
 *  next process that makes a shard removes what killed processes left of it. */
class ShardFolder {
public:
    /** @param run the inputs that determine the files: the same in all shards of a folder.
     *  Throws types::ConfigError where the folder cannot be made, or holds shards of another run or of another
     *  count. */
    ShardFolder(const std::filesystem::path& shared, const console::Shard& shard, console::Json run);
    ~ShardFolder();
    ShardFolder(const ShardFolder&) = delete;
    ShardFolder& operator=(const ShardFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }  ///< Exists once the shard is done.
    /** Returns the manifest of a finished shard. None: the shard is not done, or differs from its manifest; then it is
     *  reported on stderr, and finish() replaces it. Reads all files. */
    std::optional<console::Json> done() const;
    /** Returns an empty folder to write to; it is removed unless finish() is called. */
    const std::filesystem::path& begin();
    /** Writes the manifest, including `more`, and gives the folder its final name. Returns the existing manifest if
     *  another process has finished the shard first. */
    console::Json finish(const console::Json& more);

private:
    /** A lock on a folder, until it is destroyed or its process ends. */
    class Lock {
    public:
        Lock(const std::filesystem::path& folder, bool waits);
        ~Lock();
        Lock(const Lock&) = delete;
        Lock& operator=(const Lock&) = delete;
        bool holds() const { return holds_; }  ///< False: another process holds it, or the file system has no locks.

    private:
        int folder_;
        bool holds_;
    };

    void refuseOthers() const;
    void removeLeft() const;

    std::filesystem::path shared_, path_, part_;
    console::Shard shard_;
    console::Json run_;
    std::optional<Lock> lock_;  ///< Lock of `part_`.
};

}  // namespace insonify::deployer
