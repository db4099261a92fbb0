#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "components/log/Files.hpp"
#include "components/log/MessageDecoder.hpp"
#include "components/log/Reader.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace insonify::log::db3 {

/** Reads a bag that rosbag2 has stored as a SQLite database, in the order in which it was recorded. Messages of known
 *  types in CDR are samples, as in mcap::Reader; the position of a sample is its id in the table `messages`. Messages
 *  that rosbag2 has compressed one by one are decompressed. The database is not changed, and no file is made next to
 *  it. */
class Reader final : public log::Reader {
public:
    /** Throws ConfigError when the file cannot be read, is no bag, is damaged or is locked by another program.
     *  @param foreign axes of poses; ENU in ROS (REP 103) */
    explicit Reader(const std::filesystem::path& path, types::WorldFrame foreign = types::WorldFrame::Enu);
    ~Reader() override;

    uint64_t bytes() const override { return file_.size(); }
    std::span<const char> toBytes(const SampleRef& at) override;
    const std::string& layout(size_t stream) const override { return layouts_[stream]; }

private:
    struct Close {
        void operator()(sqlite3* database) const;
        void operator()(sqlite3_stmt* statement) const;
    };
    using Statement = std::unique_ptr<sqlite3_stmt, Close>;

    void open();
    void readTopics(types::WorldFrame foreign);
    void readMessages();
    Statement prepare(const char* query) const;
    /** Goes to the next row; false: there is none. */
    bool step(sqlite3_stmt* statement) const;
    /** Throws the reason for which SQLite cannot read. */
    [[noreturn]] void fail() const;
    std::string getPlace(const SampleRef& at) const override;
    void decode(const SampleRef& at, types::SampleRoom room) override;

    InputFile file_;
    std::unique_ptr<sqlite3, Close> database_;
    Statement message_;            ///< The data of a message by its id.
    std::vector<int64_t> topics_;  ///< Number of each stream's topic.
    std::vector<std::string> layouts_;
    std::vector<std::unique_ptr<MessageDecoder>> decoders_;  ///< One per stream; null: unknown type.
    std::vector<char> bytes_, unpacked_;                     ///< Of the last message, as stored and decompressed.
};

}  // namespace insonify::log::db3
