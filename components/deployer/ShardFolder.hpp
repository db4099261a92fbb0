#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "components/command/Json.hpp"
#include "components/command/Shard.hpp"

namespace insonify::deployer {

/** Where a shard of a run leaves its files: `shard_03_of_16` in a folder that all shards share, on any machine.
 *
 *  They are written to a hidden folder beside it that nobody else has, with `manifest.json`, the size and SHA-256 of
 *  each, as the last; then it gets its name. So that what bears the name is whole, whatever happens to who makes it,
 *  and of two who make the same shard one comes first and the other leaves nothing. What the killed have left is
 *  removed by the next who makes that shard. */
class ShardFolder {
public:
    /** @param run what the files follow from: the same in all shards of a folder.
     *  Throws types::ConfigError where the folder cannot be made, or holds shards of another run or of another count.
     */
    ShardFolder(const std::filesystem::path& shared, const command::Shard& shard, command::Json run);
    ~ShardFolder();
    ShardFolder(const ShardFolder&) = delete;
    ShardFolder& operator=(const ShardFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }  ///< Once it is done.
    /** The manifest of a shard that is done; none: it is not, or is not as its manifest says, which has been told on
     *  stderr and is removed. Reads all files. */
    std::optional<command::Json> done() const;
    /** An empty folder to write to, which goes unless finish() is called. */
    const std::filesystem::path& begin();
    /** Writes the manifest, with `more` in it, and gives the folder its name. The manifest of who came first where
     *  another has done the shard meanwhile. */
    command::Json finish(const command::Json& more);

private:
    /** Of a folder, until it goes or its process ends. */
    class Lock {
    public:
        Lock(const std::filesystem::path& folder, bool waits);
        ~Lock();
        Lock(const Lock&) = delete;
        Lock& operator=(const Lock&) = delete;
        bool holds() const { return holds_; }  ///< False: another has it, or the file system knows no locks.

    private:
        int folder_;
        bool holds_;
    };

    void refuseOthers() const;
    void removeLeft() const;

    std::filesystem::path shared_, path_, part_;
    command::Shard shard_;
    command::Json run_;
    std::optional<Lock> lock_;  ///< Of `part_`.
};

}  // namespace insonify::deployer
