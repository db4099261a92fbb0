#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "components/log/Files.hpp"
#include "components/log/mcap/ChunkWriter.hpp"

namespace insonify::log::mcap {

/** Where one message stands. */
struct MessageRef {
    uint16_t channel = 0;
    uint64_t log_ns = 0, publish_ns = 0;
    uint64_t position = 0;  ///< Of its bytes in the file, or of the compressed chunk that holds it [B].
    uint32_t size = 0;      ///< [B]
    uint32_t offset = 0;    ///< In the records of a compressed chunk [B].
    bool compressed = false;
};

/** A chunk as its record tells. */
struct ChunkInfo {
    uint64_t start = 0, length = 0;  ///< Of the record [B].
    uint64_t first_ns = 0, last_ns = 0;
    uint64_t size = 0;                          ///< Of the records in it, decompressed [B].
    uint64_t records_at = 0, records_size = 0;  ///< As they stand in the file [B].
    uint32_t crc = 0;                           ///< 0: none.
    std::string compression;
    /** Place of each message by its offset in the records. */
    std::map<uint64_t, std::pair<uint16_t, uint64_t>> messages;  ///< Channel and log time.
};

/** What a file holds. */
struct Contents {
    std::map<uint16_t, Schema> schemas;
    std::map<uint16_t, Channel> channels;
    std::vector<MessageRef> messages;  ///< In file order.
    std::vector<ChunkInfo> chunks;
    struct Metadata {
        uint64_t start = 0, length = 0;
        size_t channels_before = 0;
        std::string name;
        Texts texts;
    };
    std::vector<Metadata> metadata;
    uint32_t attachments = 0;
    std::vector<Gap> gaps;  ///< What was not read, in file order.
    uint64_t read_to = 0;   ///< The end of the last whole record of the data [B].
    uint32_t crc = 0;       ///< Of the file up to there.
};

/** An open MCAP file. */
class File {
public:
    /** Throws ConfigError when it cannot be read. */
    explicit File(const std::filesystem::path& path) : path_(path), file_(path) {}

    uint64_t size() const { return file_.size(); }
    /** Passes over the whole file: each record, each chunk with its checksum, indices and summary. What is wrong ends
     *  it, or with AtDamage::Skip only what is whole is taken: chunks of the right checksum, and messages that stand
     *  alone or in a chunk that has lost its header or end. Throws ConfigError for what does not begin as an MCAP file,
     *  with Skip for what holds no channel either. */
    Contents contents(AtDamage at_damage = AtDamage::Stop);
    /** The bytes of a message. Throws FormatError when they cannot be read any more. */
    void read(const MessageRef& at, std::vector<char>& to);

    struct Record {
        Op op{};
        uint64_t start = 0;
        std::array<char, record_header_size> header{};
        std::span<const char> content{};  ///< Good until the next one is read.
        uint64_t end() const { return start + record_header_size + content.size(); }
        RecordReader reader() const { return {content, start + record_header_size}; }
    };
    /** The record at a place. Throws FormatError for what is none. */
    Record record(uint64_t at);
    /** Throws FormatError unless the file ends with the magic that begins there. */
    void expectEnd(uint64_t at) const;

private:
    void readStrictly(Contents& found);
    void readWhatIsWhole(Contents& found);
    /** The first place from there on at which a record seems to stand, or the end of the file. */
    uint64_t nextRecord(uint64_t position) const;
    bool looksLikeRecord(uint64_t at) const;
    /** Kind and end of a record whose header can be: none for others. */
    std::optional<std::pair<Op, uint64_t>> header(uint64_t at) const;
    bool hasMagic(uint64_t at) const;

    std::filesystem::path path_;
    InputFile file_;
    std::vector<char> content_;
    std::optional<uint64_t> unpacked_;  ///< The chunk that is in:
    std::vector<char> records_;
};

/** A description of a chunk's record, without its messages. Throws FormatError. */
ChunkInfo chunkInfo(const File::Record& record);

/** The records of a chunk, decompressed where they are not plain, checked against their size and checksum. Throws
 *  FormatError for damaged ones and for a compression that is not read. */
std::span<const char> recordsOf(const ChunkInfo& chunk, std::span<const char> stored, std::vector<char>& room);

/** Compares summary and footer, which stand behind the data, with the data. Throws FormatError for what differs. */
void checkSummary(File& file, const Contents& contents);

uint32_t checksum(std::span<const char> bytes, uint32_t before = 0);

}  // namespace insonify::log::mcap
