#include "components/log/db3/Reader.hpp"

#include <sqlite3.h>
#include <zstd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>

#include "types/text/ConfigError.hpp"

namespace insonify::log::db3 {
namespace {

constexpr size_t header_size = 100;  // of SQLite's file format
constexpr std::string_view magic{"SQLite format 3\0", 16};
const std::string damaged = "is damaged or incomplete; `sqlite3 FILE .recover` prints what is left of it";
constexpr size_t max_message = size_t{1} << 30;  ///< [B]

/** Whether a database has changes in a log next to it. */
bool hasLog(const std::filesystem::path& path) {
    std::error_code none;
    const auto size = std::filesystem::file_size(path.string() + "-wal", none);
    return !none && size > 0;
}

/** Returns a number of SQLite's header, whose bytes begin with the highest. */
uint32_t numberAt(const char* header, size_t at, size_t size) {
    uint32_t number = 0;
    for (size_t i = 0; i < size; ++i) number = number << 8 | static_cast<unsigned char>(header[at + i]);
    return number;
}

/** Returns the size that a database states [B]; 0: it states none. */
uint64_t statedSize(const char* header) {
    const uint64_t page = numberAt(header, 16, 2);
    const bool is_valid = numberAt(header, 24, 4) == numberAt(header, 92, 4);
    return is_valid ? (page == 1 ? 65536 : page) * numberAt(header, 28, 4) : 0;
}

/** Returns the address of a file for SQLite. A database in the state of write-ahead logging is read as unchanging where
 *  it has no log: SQLite would make one next to it. */
std::string findAddress(const std::filesystem::path& path, bool logs_ahead) {
    std::string address = "file:";
    for (const char c : std::filesystem::absolute(path).string()) {
        const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                              std::string_view("/-_.~").find(c) != std::string_view::npos;
        char coded[4];
        if (!is_plain) std::snprintf(coded, sizeof coded, "%%%02X", static_cast<unsigned char>(c));
        address += is_plain ? std::string(1, c) : coded;
    }
    return address + (logs_ahead && !hasLog(path) ? "?mode=ro&immutable=1" : "?mode=ro");
}

std::string textAt(sqlite3_stmt* row, int column) {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
    return text ? std::string(text, static_cast<size_t>(sqlite3_column_bytes(row, column))) : "";
}

/** Decompresses a message. Throws std::runtime_error for other bytes. */
void unpack(std::span<const char> packed, std::vector<char>& to) {
    const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
    if (size > max_message) throw std::runtime_error("is compressed, without a size of up to 1 GiB");
    to.resize(size);
    const size_t got = ZSTD_decompress(to.data(), to.size(), packed.data(), packed.size());
    if (ZSTD_isError(got) != 0 || got != size) throw std::runtime_error("is compressed, and damaged");
}

}  // namespace

void Reader::Close::operator()(sqlite3* database) const { sqlite3_close(database); }
void Reader::Close::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Reader::Reader(const std::filesystem::path& path, types::WorldFrame foreign) : log::Reader(path), file_(path) {
    open();
    readTopics(foreign);
    readMessages();
    message_ = prepare("SELECT data FROM messages WHERE id = ?1");
}

Reader::~Reader() = default;

void Reader::open() {
    char header[header_size];
    if (!file_.read(0, header, sizeof header) || std::string_view(header, magic.size()) != magic)
        throw types::ConfigError(path(), "", "is no SQLite database, as a .db3 file of ros2 bag is");
    if (const uint64_t stated = statedSize(header); stated > bytes() && !hasLog(path()))
        throw types::ConfigError(
            path(), "", damaged + " (it has " + std::to_string(bytes()) + " bytes of " + std::to_string(stated) + ")");
    sqlite3* opened = nullptr;
    const int code = sqlite3_open_v2(findAddress(path(), header[18] == 2).c_str(), &opened,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
    database_.reset(opened);
    if (code != SQLITE_OK) fail();
    sqlite3_busy_timeout(opened, 1000);  // [ms]
    // The file may be anybody's: no blob is larger than the file, and nothing in it runs.
    sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(std::clamp<uint64_t>(bytes(), 4096, max_message)));
    for (const char* careful : {"PRAGMA trusted_schema = OFF", "PRAGMA cell_size_check = ON"})
        step(prepare(careful).get());
    const Statement tables = prepare(
        "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages') AND sql LIKE "
        "'CREATE TABLE%'");
    if (!step(tables.get()) || sqlite3_column_int(tables.get(), 0) != 2)
        throw types::ConfigError(path(), "", "is a SQLite database without the tables topics and messages of ros2 bag");
}

void Reader::readTopics(types::WorldFrame foreign) {
    static const Metadata no_texts;
    std::map<std::string, std::string> definitions;
    const Statement has = prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'message_definitions'");
    if (step(has.get())) {  // since ROS 2 Iron
        const Statement row = prepare(
            "SELECT topic_type, encoded_message_definition FROM message_definitions WHERE encoding = 'ros2msg'");
        while (step(row.get())) definitions[textAt(row.get(), 0)] = textAt(row.get(), 1);
    }
    const Statement row = prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    while (step(row.get())) {
        const DeclaredTopic topic{textAt(row.get(), 1), textAt(row.get(), 2), textAt(row.get(), 3), &no_texts, foreign};
        topics_.push_back(sqlite3_column_int64(row.get(), 0));
        streams_.push_back(getStream(topic));
        decoders_.push_back(makeDecoder(topic));
        layouts_.push_back(definitions[topic.type]);
    }
}

void Reader::readMessages() {
    const Statement row = prepare("SELECT id, topic_id, timestamp FROM messages ORDER BY id");
    while (step(row.get())) {
        const int64_t id = sqlite3_column_int64(row.get(), 0), topic = sqlite3_column_int64(row.get(), 1);
        const auto found = std::ranges::find(topics_, topic);
        if (found == topics_.end())
            throw types::ConfigError(path(), "messages",
                                     "the message of id " + std::to_string(id) + " is of topic " +
                                         std::to_string(topic) + ", which is not there: the bag is damaged");
        const types::Time time{sqlite3_column_int64(row.get(), 2) / 1000};
        addSample(static_cast<size_t>(found - topics_.begin()), time, time, static_cast<uint64_t>(id));
    }
}

Reader::Statement Reader::prepare(const char* query) const {
    sqlite3_stmt* made = nullptr;
    if (sqlite3_prepare_v2(database_.get(), query, -1, &made, nullptr) != SQLITE_OK) fail();
    return Statement(made);
}

bool Reader::step(sqlite3_stmt* statement) const {
    const int code = sqlite3_step(statement);
    if (code != SQLITE_ROW && code != SQLITE_DONE) fail();
    return code == SQLITE_ROW;
}

void Reader::fail() const {
    const int code = sqlite3_errcode(database_.get()) & 0xff;
    const std::string reason = std::string(" (SQLite: ") + sqlite3_errmsg(database_.get()) + ")";
    if (code == SQLITE_BUSY || code == SQLITE_LOCKED)
        throw types::ConfigError(path(), "", "is locked: another program writes it; wait until it has ended" + reason);
    if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB) throw types::ConfigError(path(), "", damaged + reason);
    throw types::ConfigError(path(), "", "cannot be read as a bag of ros2 bag" + reason);
}

std::string Reader::getPlace(const SampleRef& at) const { return "of id " + std::to_string(at.position); }

std::span<const char> Reader::toBytes(const SampleRef& at) try {
    sqlite3_bind_int64(message_.get(), 1, static_cast<int64_t>(at.position));
    if (!step(message_.get())) failSample(at, "is no longer there");
    const auto* const data = static_cast<const char*>(sqlite3_column_blob(message_.get(), 0));
    bytes_.assign(data, data + sqlite3_column_bytes(message_.get(), 0));
    sqlite3_reset(message_.get());  // which also unlocks the database
    if (!std::string_view(bytes_.data(), bytes_.size()).starts_with("\x28\xb5\x2f\xfd")) return bytes_;  // zstd's magic
    unpack(bytes_, unpacked_);
    return unpacked_;
} catch (const types::ConfigError&) {
    throw;
} catch (const std::runtime_error& error) {
    failSample(at, error.what());
}

void Reader::decode(const SampleRef& at, types::SampleRoom room) { decoders_[at.stream]->decode(toBytes(at), room); }

}  // namespace insonify::log::db3
