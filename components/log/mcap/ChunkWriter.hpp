#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/log/Files.hpp"
#include "components/log/mcap/Records.hpp"

namespace insonify::log::mcap {

/** The declaration of a message type. */
struct Schema {
    std::string name, encoding, text;
    friend auto operator<=>(const Schema&, const Schema&) = default;
};

/** A stream of messages. */
struct Channel {
    uint16_t schema = 0;
    std::string topic, encoding;
    Texts metadata;
};

/** The contents of one file. */
struct FileSummary {
    std::filesystem::path path;
    uint64_t messages = 0;
    uint64_t first_ns = 0, last_ns = 0;  ///< Earliest and latest log time [ns].
    std::vector<uint64_t> counts;        ///< One per channel, in order.
};

/** Writes an MCAP file of the profile "ros2": uncompressed chunks with checksums and indices.
 *
 *  Messages are collected in memory and written in chunks of a megabyte, or by flush(). The complete chunks of a
 *  truncated file stay readable. A failed write throws std::runtime_error with the system's reason; earlier writes
 *  stay. After a failure the writer accepts no message until next(). For one thread. */
class ChunkWriter {
public:
    /** Throws ConfigError as OutputFile. */
    explicit ChunkWriter(std::filesystem::path path);
    ~ChunkWriter();  ///< As of log::Writer.

    /** Return the number of the schema, from 1, or channel, from 0. Throw std::length_error for the 65536th. */
    uint16_t addSchema(Schema schema);
    uint16_t addChannel(Channel channel);
    /** Whether a message counts in kept(). */
    enum class Counts { Yes, No };
    /** Adds a message; times since 1970 [ns]. Throws std::runtime_error when the file is closed. */
    void write(uint16_t channel, uint64_t log_ns, uint64_t publish_ns, std::span<const char> bytes,
               Counts counts = Counts::Yes);
    void addMetadata(const std::string& name, const Texts& texts);

    void flush();  ///< Ends the chunk: its messages survive the end of this process.
    void sync();   ///< Flushes, and waits until the messages are on the disk.
    bool syncs() const { return file_ && file_->syncs(); }  ///< Whether sync() has been called for this file.
    void close();  ///< Flushes and writes the summary. Nothing may be written afterwards.
    /** Drops the messages that are not in the file, after a failed write. */
    void discard();
    /** Closes and continues in another file, with the same schemas, channels and metadata. */
    void next(std::filesystem::path path);

    bool isOpen() const { return file_ && file_->isOpen(); }  ///< False after a failed write.
    const std::filesystem::path& path() const { return summary_.path; }
    uint64_t size() const { return position() + chunk_.size(); }  ///< Including unflushed messages [B].
    uint64_t kept() const { return kept_; }                       ///< Messages in all files [1].
    bool isEmpty() const { return file_ && file_->size() == 0 && chunk_messages_ == 0; }  ///< Nor has samples.
    const FileSummary& summary() const { return summary_; }          ///< Summary of the present file.
    const std::vector<Schema>& schemas() const { return schemas_; }  ///< Number 1 is the first.
    const std::vector<Channel>& channels() const { return channels_; }

private:
    struct IndexEntry {
        uint64_t time_ns, offset;
    };
    struct ChunkIndex {
        uint64_t first_ns, last_ns, start, length, size;  ///< Place, length and size of the records [B].
        std::vector<std::pair<uint16_t, uint64_t>> indices;
        uint64_t indices_length;
    };
    struct MetadataIndex {
        uint64_t start, length;
        std::string name;
    };

    void open();
    /** End of the data so far [B]. */
    uint64_t position() const { return (file_ ? file_->size() : 0) + head_.size(); }
    void openChunk();
    void closeChunk(ChunkIndex& index);
    void append(const std::vector<char>& bytes);
    void putSchema(RecordWriter& out, size_t number) const;
    void putChannel(RecordWriter& out, size_t number) const;
    void putMetadata(const std::string& name, const Texts& texts);
    void putStatistics(RecordWriter& out) const;
    void putChunkIndex(RecordWriter& out, const ChunkIndex& index) const;
    std::vector<char> summaryBytes() const;

    std::optional<OutputFile> file_;
    std::vector<char> head_;  ///< First bytes of the file, until others follow them.
    FileSummary summary_;
    uint32_t crc_ = 0;  ///< Checksum of all bytes in the file.
    uint64_t kept_ = 0;
    std::vector<Schema> schemas_;
    std::vector<Channel> channels_;
    std::vector<std::pair<std::string, Texts>> metadata_;
    std::vector<MetadataIndex> metadata_index_;
    std::vector<ChunkIndex> chunks_;

    std::vector<char> chunk_;  ///< Space for its header, then its records.
    uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0, chunk_messages_ = 0, chunk_counted_ = 0;
    std::vector<std::vector<IndexEntry>> index_;  ///< Entries of the chunk's messages, for each channel.
};

}  // namespace insonify::log::mcap
