#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "components/log/Files.hpp"
#include "components/log/mcap/ChunkWriter.hpp"

namespace insonify::log::mcap {

/** The place of one message. */
struct MessageRef {
    uint16_t channel = 0;
    uint64_t log_ns = 0, publish_ns = 0;
    uint64_t position = 0;  ///< Position of its bytes in the file, or of the compressed chunk around it [B].
    uint32_t size = 0;      ///< [B]
    uint32_t offset = 0;    ///< In the records of a compressed chunk [B].
    bool compressed = false;
};

/** A chunk as its record states. */
struct ChunkInfo {
    uint64_t start = 0, length = 0;  ///< Start and length of the record [B].
    uint64_t first_ns = 0, last_ns = 0;
    uint64_t size = 0;                          ///< Size of the decompressed records [B].
    uint64_t records_at = 0, records_size = 0;  ///< As stored in the file [B].
    uint32_t crc = 0;                           ///< 0: none.
    std::string compression;
    /** The messages by their offset in the records, until their indices have been read: channel and log time. */
    std::map<uint64_t, std::pair<uint16_t, uint64_t>> messages;
};

/** The contents of a file. */
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
    std::vector<Gap> gaps;  ///< Skipped parts, in file order.
    uint64_t read_to = 0;   ///< The end of the last complete record of the data [B].
    uint32_t crc = 0;       ///< Checksum of the file up to read_to.
};

/** An open MCAP file. */
class File {
public:
    /** Throws ConfigError when it cannot be read. */
    explicit File(const std::filesystem::path& path) : path_(path), file_(path) {}

    uint64_t size() const { return file_.size(); }
    /** Reads the whole file: each record, each chunk with its checksum, indices and summary. It stops at an error. With
     *  AtDamage::Skip it continues with the intact parts: chunks with a right checksum, and messages outside of chunks
     *  or in a chunk that has lost its header or end. Throws ConfigError for a file that does not begin as an MCAP
     *  file; with Skip, only if it also has no channel. */
    Contents contents(AtDamage at_damage = AtDamage::Stop);
    /** Reads the bytes of a message. Throws FormatError when they can no longer be read. */
    void read(const MessageRef& at, std::vector<char>& to);

    struct Record {
        Op op{};
        uint64_t start = 0;
        std::array<char, record_header_size> header{};
        std::span<const char> content{};  ///< Valid until the next record is read.
        uint64_t end() const { return start + record_header_size + content.size(); }
        RecordReader reader() const { return {content, start + record_header_size}; }
    };
    /** Returns the record at a place. Throws FormatError if there is none. */
    Record record(uint64_t at);
    /** Throws FormatError unless the file ends with the magic at this place. */
    void expectEnd(uint64_t at) const;

private:
    void readStrictly(Contents& found);
    void readWhatIsWhole(Contents& found);
    /** Returns the first place from `position` on with a plausible record, or the end of the file. */
    uint64_t nextRecord(uint64_t position) const;
    bool looksLikeRecord(uint64_t at) const;
    /** Returns kind and end of a record with a possible header; none for others. */
    std::optional<std::pair<Op, uint64_t>> header(uint64_t at) const;
    bool hasMagic(uint64_t at) const;

    std::filesystem::path path_;
    InputFile file_;
    std::vector<char> content_;
    std::optional<uint64_t> unpacked_;  ///< The chunk whose records are in:
    std::vector<char> records_;
};

/** Returns the description of a chunk's record, without its messages. Throws FormatError. */
ChunkInfo chunkInfo(const File::Record& record);

/** Returns the records of a chunk, decompressed if necessary and checked against their size and checksum. Throws
 *  FormatError for damaged records and for an unsupported compression. */
std::span<const char> getRecords(const ChunkInfo& chunk, std::span<const char> stored, std::vector<char>& room);

/** Compares the summary and footer behind the data with the data. Throws FormatError at a difference. */
void checkSummary(File& file, const Contents& contents);

uint32_t checksum(std::span<const char> bytes, uint32_t before = 0);

}  // namespace insonify::log::mcap
