#include "components/log/mcap/Contents.hpp"

#include <algorithm>
#include <limits>

#include "types/ConfigError.hpp"

namespace insonify::log::mcap {
namespace {

/** Fills Contents, record by record. */
class Collector {
public:
    /** Takes an intact file's records in order, with the indices. Of a damaged file, first takes all declarations (also
     *  in a summary; the first of those with one number), then the messages. */
    enum class Takes { Strictly, Declarations, Messages };
    explicit Collector(Contents& contents, Takes takes = Takes::Strictly) : found_(contents), takes_(takes) {}

    /** False for the record that ends the data. */
    bool take(const File::Record& record) {
        RecordReader reader = record.reader();
        if (record.op == Op::Chunk)
            chunk(record);
        else if (record.op == Op::Metadata)
            metadata(record, reader);
        else if (record.op == Op::Attachment)
            ++found_.attachments;
        else if (record.op == Op::MessageIndex && takes_ == Takes::Strictly)
            index(reader);
        else if (record.op == Op::DataEnd)
            return false;
        else if (record.op == Op::Footer && takes_ == Takes::Strictly)
            throw FormatError(record.start, "a footer without an end of the data before it");
        else
            basic(record.op, reader, nullptr);
        return true;
    }

private:
    /** Takes the records allowed both inside and outside of chunks. */
    void basic(Op op, RecordReader& reader, const ChunkInfo* chunk) {
        const uint64_t at = reader.at();
        if (op == Op::Schema)
            schema(reader);
        else if (op == Op::Channel)
            channel(reader);
        else if (op == Op::Message)
            message(reader, chunk);
        else if (chunk || op < Op::Header || (op == Op::Header && takes_ == Takes::Strictly))
            throw FormatError(at - record_header_size,
                              "a record of kind " + std::to_string(static_cast<int>(op)) + " is not allowed here");
    }

    void schema(RecordReader& reader) {
        const uint64_t at = reader.at();
        const auto number = reader.number<uint16_t>();
        if (number == 0) throw FormatError(at, "a schema has the number 0");
        Schema schema;
        schema.name = reader.text();
        schema.encoding = reader.text();
        schema.text = reader.text();
        if (takes_ == Takes::Strictly)
            found_.schemas[number] = std::move(schema);
        else
            found_.schemas.emplace(number, std::move(schema));
    }

    void channel(RecordReader& reader) {
        const auto number = reader.number<uint16_t>();
        Channel channel;
        const uint64_t at = reader.at();
        channel.schema = reader.number<uint16_t>();
        if (channel.schema != 0 && !found_.schemas.contains(channel.schema))
            throw FormatError(at, "a channel names schema " + std::to_string(channel.schema) + ", which is not there");
        channel.topic = reader.text();
        channel.encoding = reader.text();
        channel.metadata = reader.texts();
        if (takes_ == Takes::Strictly)
            found_.channels[number] = std::move(channel);
        else
            found_.channels.emplace(number, std::move(channel));
    }

    void metadata(const File::Record& record, RecordReader& reader) {
        Contents::Metadata found{record.start, record.end() - record.start, found_.channels.size(), reader.text(), {}};
        found.texts = reader.texts();
        if (takes_ != Takes::Messages) found_.metadata.push_back(std::move(found));
    }

    void message(RecordReader& reader, const ChunkInfo* chunk) {
        if (takes_ == Takes::Declarations) return;
        const uint64_t start = reader.at() - record_header_size;
        MessageRef message;
        message.channel = reader.number<uint16_t>();
        if (!found_.channels.contains(message.channel))
            throw FormatError(start + record_header_size,
                              "a message names channel " + std::to_string(message.channel) + ", which is not there");
        reader.number<uint32_t>();
        message.log_ns = reader.number<uint64_t>();
        message.publish_ns = reader.number<uint64_t>();
        if (reader.left() > std::numeric_limits<uint32_t>::max())
            throw FormatError(start, "a message of more than 4 GiB");
        message.size = static_cast<uint32_t>(reader.left());
        message.position = reader.at();
        if (chunk) inChunk(*chunk, start, message);
        found_.messages.push_back(message);
    }

    void inChunk(const ChunkInfo& chunk, uint64_t start, MessageRef& message) {
        if (message.log_ns < chunk.first_ns || message.log_ns > chunk.last_ns)
            throw FormatError(start, "the message's time is outside that of its chunk");
        if (takes_ == Takes::Strictly)
            found_.chunks.back().messages[start - chunk.records_at] = {message.channel, message.log_ns};
        if (chunk.compression.empty()) return;
        message.offset = static_cast<uint32_t>(message.position - chunk.records_at);
        message.position = chunk.start;
        message.compressed = true;
    }

    void chunk(const File::Record& record) {
        if (!found_.chunks.empty()) found_.chunks.back().messages.clear();  // its indices have been read
        found_.chunks.push_back(chunkInfo(record));
        const ChunkInfo& chunk = found_.chunks.back();
        const size_t messages = found_.messages.size();
        try {
            const uint64_t inside = chunk.records_at - record.start - record_header_size;
            records(recordsOf(chunk, record.content.subspan(inside), unpacked_));
        } catch (const FormatError&) {
            found_.messages.resize(messages);
            found_.chunks.pop_back();
            throw;
        }
    }

    void records(std::span<const char> bytes) {
        const ChunkInfo& chunk = found_.chunks.back();
        RecordReader all(bytes, chunk.records_at);
        while (all.left() > 0) {
            const auto op = all.number<Op>();
            const std::string_view content = all.take(all.number<uint64_t>());
            RecordReader reader(content, all.at() - content.size());
            basic(op, reader, &chunk);
        }
    }

    void index(RecordReader& reader) const {
        const uint64_t start = reader.at();
        const auto channel = reader.number<uint16_t>();
        if (found_.chunks.empty()) throw FormatError(start, "an index of messages without a chunk before it");
        const auto& messages = found_.chunks.back().messages;
        for (RecordReader entries = reader.part(); entries.left() > 0;) {
            const uint64_t at = entries.at();
            const auto time_ns = entries.number<uint64_t>();
            const auto found = messages.find(entries.number<uint64_t>());
            if (found == messages.end() || found->second != std::pair(channel, time_ns))
                throw FormatError(at, "the index has a message that is not in the file");
        }
    }

    Contents& found_;
    const Takes takes_;
    std::vector<char> unpacked_;
};

}  // namespace

ChunkInfo chunkInfo(const File::Record& record) {
    RecordReader reader = record.reader();
    ChunkInfo chunk;
    chunk.start = record.start;
    chunk.length = record.end() - record.start;
    chunk.first_ns = reader.number<uint64_t>();
    chunk.last_ns = reader.number<uint64_t>();
    chunk.size = reader.number<uint64_t>();
    chunk.crc = reader.number<uint32_t>();
    chunk.compression = reader.text();
    chunk.records_size = reader.number<uint64_t>();
    chunk.records_at = reader.at();
    if (chunk.records_size != reader.left())
        throw FormatError(chunk.records_at - sizeof(uint64_t),
                          "a chunk announces " + std::to_string(chunk.records_size) + " bytes of records and has " +
                              std::to_string(reader.left()));
    return chunk;
}

Contents File::contents(AtDamage at_damage) {
    Contents found;
    const bool begins = hasMagic(0);
    if (at_damage == AtDamage::Stop && !begins) throw types::ConfigError(path_, "", "is no MCAP file");
    if (!begins)
        found.gaps.push_back(
            {0, std::min<uint64_t>(magic.size(), size()), 0, "the file does not begin as an MCAP file"});
    at_damage == AtDamage::Stop ? readStrictly(found) : readWhatIsWhole(found);
    if (!begins && found.channels.empty()) throw types::ConfigError(path_, "", "is no MCAP file");
    return found;
}

void File::readStrictly(Contents& found) {
    Collector collector(found);
    found.read_to = magic.size();
    found.crc = checksum(magic);
    const auto pass = [&](const Record& record) {
        found.crc = checksum(record.content, checksum(record.header, found.crc));
        found.read_to = record.end();
    };
    try {
        Record next = record(magic.size());
        if (next.op != Op::Header) throw FormatError(next.start, "the first record is no header");
        RecordReader reader = next.reader();
        reader.text();  // any profile
        reader.text();
        do {
            pass(next);
            next = record(found.read_to);
        } while (collector.take(next));
        checkSummary(*this, found);
    } catch (const FormatError& error) {
        found.gaps.push_back({found.read_to, size(), error.byte, error.what()});
    }
}

void File::readWhatIsWhole(Contents& found) {
    Collector declarations(found, Collector::Takes::Declarations);
    for (uint64_t at = magic.size(); at < size(); at = nextRecord(at)) try {
            while (at < size()) {
                const Record next = record(at);
                declarations.take(next);
                at = next.end();
            }
        } catch (const FormatError&) {
            ++at;  // reported in the next pass
        }
    Collector collector(found, Collector::Takes::Messages);
    bool ended = false;
    for (uint64_t at = magic.size(); at < size() && !(ended && hasMagic(at));) try {
            const Record next = record(at);
            if (next.op < Op::Header || next.op > Op::DataEnd)
                throw FormatError(at,
                                  "a record of kind " + std::to_string(static_cast<int>(next.op)) + " is not known");
            ended = ended || next.op == Op::Footer;
            collector.take(next);
            at = next.end();
        } catch (const FormatError& error) {
            const auto whole = header(at);
            const uint64_t next = whole && looksLikeRecord(whole->second) ? whole->second : nextRecord(at + 1);
            addGap(found.gaps, {at, next, error.byte, error.what()});
            at = next;
        }
    if (!ended && found.gaps.empty())
        found.gaps.push_back({size(), size(), size(), "the file ends here, without a footer"});
}

}  // namespace insonify::log::mcap
