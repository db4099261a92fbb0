#include "components/mcap/Contents.hpp"

#include <algorithm>
#include <limits>

#include "types/ConfigError.hpp"

namespace insonify::mcap {
namespace {

/** Fills Contents, record by record. */
class Collector {
public:
    explicit Collector(Contents& contents) : found_(contents) {}

    /** False for the record that ends the data. */
    bool take(const File::Record& record) {
        RecordReader reader = record.reader();
        if (record.op == Op::Chunk)
            chunk(record);
        else if (record.op == Op::Metadata)
            found_.metadata.push_back(
                {record.start, record.end() - record.start, found_.channels.size(), reader.text(), reader.texts()});
        else if (record.op == Op::Attachment)
            ++found_.attachments;
        else if (record.op == Op::MessageIndex)
            index(reader);
        else if (record.op == Op::DataEnd)
            return false;
        else if (record.op == Op::Footer)
            throw Fault(record.start, "a footer without an end of the data before it");
        else
            basic(record.op, reader, nullptr);
        return true;
    }

private:
    /** What may stand in chunks and outside. */
    void basic(Op op, RecordReader& reader, const ChunkInfo* chunk) {
        const uint64_t at = reader.at();
        if (op == Op::Schema)
            schema(reader);
        else if (op == Op::Channel)
            channel(reader);
        else if (op == Op::Message)
            message(reader, chunk);
        else if (chunk || op < Op::Header || op == Op::Header)
            throw Fault(at - record_header_size,
                        "a record of kind " + std::to_string(static_cast<int>(op)) + " may not stand here");
    }

    void schema(RecordReader& reader) {
        const uint64_t at = reader.at();
        const auto number = reader.number<uint16_t>();
        if (number == 0) throw Fault(at, "a schema has the number 0");
        Schema& schema = found_.schemas[number];
        schema.name = reader.text();
        schema.encoding = reader.text();
        schema.text = reader.text();
    }

    void channel(RecordReader& reader) {
        const auto number = reader.number<uint16_t>();
        Channel& channel = found_.channels[number];
        const uint64_t at = reader.at();
        channel.schema = reader.number<uint16_t>();
        if (channel.schema != 0 && !found_.schemas.contains(channel.schema))
            throw Fault(at, "a channel names schema " + std::to_string(channel.schema) + ", which is not there");
        channel.topic = reader.text();
        channel.encoding = reader.text();
        channel.metadata = reader.texts();
    }

    void message(RecordReader& reader, const ChunkInfo* chunk) {
        const uint64_t start = reader.at() - record_header_size;
        MessageRef message;
        message.channel = reader.number<uint16_t>();
        if (!found_.channels.contains(message.channel))
            throw Fault(start + record_header_size,
                        "a message names channel " + std::to_string(message.channel) + ", which is not there");
        reader.number<uint32_t>();
        message.log_ns = reader.number<uint64_t>();
        message.publish_ns = reader.number<uint64_t>();
        if (reader.left() > std::numeric_limits<uint32_t>::max()) throw Fault(start, "a message of more than 4 GiB");
        message.size = static_cast<uint32_t>(reader.left());
        message.position = reader.at();
        if (chunk) inChunk(*chunk, start, message);
        found_.messages.push_back(message);
    }

    void inChunk(const ChunkInfo& chunk, uint64_t start, MessageRef& message) {
        if (message.log_ns < chunk.first_ns || message.log_ns > chunk.last_ns)
            throw Fault(start, "the message's time is outside that of its chunk");
        found_.chunks.back().messages[start - chunk.records_at] = {message.channel, message.log_ns};
        if (chunk.compression.empty()) return;
        message.offset = static_cast<uint32_t>(message.position - chunk.records_at);
        message.position = chunk.start;
        message.compressed = true;
    }

    void chunk(const File::Record& record) {
        found_.chunks.push_back(chunkInfo(record));
        const ChunkInfo& chunk = found_.chunks.back();
        const size_t messages = found_.messages.size();
        try {
            const uint64_t inside = chunk.records_at - record.start - record_header_size;
            records(recordsOf(chunk, record.content.subspan(inside), unpacked_));
        } catch (const Fault&) {
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
        if (found_.chunks.empty()) throw Fault(start, "an index of messages without a chunk before it");
        const auto& messages = found_.chunks.back().messages;
        for (RecordReader entries = reader.part(); entries.left() > 0;) {
            const uint64_t at = entries.at();
            const auto time_ns = entries.number<uint64_t>();
            const auto found = messages.find(entries.number<uint64_t>());
            if (found == messages.end() || found->second != std::pair(channel, time_ns))
                throw Fault(at, "the index tells of a message that is not there");
        }
    }

    Contents& found_;
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
        throw Fault(chunk.records_at - sizeof(uint64_t), "a chunk announces " + std::to_string(chunk.records_size) +
                                                             " bytes of records and has " +
                                                             std::to_string(reader.left()));
    return chunk;
}

File::File(const std::filesystem::path& path) : file_(path) {
    char bytes[magic.size()];
    if (!file_.read(0, bytes, sizeof bytes) || std::string_view(bytes, sizeof bytes) != magic)
        throw types::ConfigError(path, "", "is no MCAP file");
}

void File::expectEnd(uint64_t at) const {
    char bytes[magic.size()];
    if (size() - at < sizeof bytes || !file_.read(at, bytes, sizeof bytes))
        throw Fault(size(), "the file ends within its last eight bytes");
    if (std::string_view(bytes, sizeof bytes) != magic) throw Fault(at, "the file does not end as an MCAP file");
    if (size() > at + sizeof bytes) throw Fault(at + sizeof bytes, "the file goes on after its end");
}

File::Record File::record(uint64_t at) {
    Record record{.start = at};
    if (at == size()) throw Fault(at, "the file ends here, without a footer");
    if (at > size() || size() - at < record.header.size() ||
        !file_.read(at, record.header.data(), record.header.size()))
        throw Fault(size(), "the file ends within a record");
    uint64_t length = 0;
    std::memcpy(&length, record.header.data() + 1, sizeof length);
    if (length > size() - at - record.header.size())
        throw Fault(size(), "the file ends within a record of " + std::to_string(length) + " bytes");
    content_.resize(length);
    if (!file_.read(at + record.header.size(), content_.data(), length)) throw Fault(at, "a record cannot be read");
    record.op = static_cast<Op>(record.header[0]);
    record.content = content_;
    return record;
}

Contents File::contents() {
    Contents found;
    Collector collector(found);
    found.read_to = magic.size();
    found.crc = checksum(magic);
    const auto pass = [&](const Record& record) {
        found.crc = checksum(record.content, checksum(record.header, found.crc));
        found.read_to = record.end();
    };
    try {
        Record next = record(magic.size());
        if (next.op != Op::Header) throw Fault(next.start, "the first record is no header");
        RecordReader reader = next.reader();
        reader.text();  // any profile
        reader.text();
        do {
            pass(next);
            next = record(found.read_to);
        } while (collector.take(next));
        checkSummary(*this, found);
    } catch (const Fault& fault) {
        found.fault = fault;
    }
    return found;
}

void File::read(const MessageRef& at, std::vector<char>& to) {
    to.resize(at.size);
    if (!at.compressed) {
        if (!file_.read(at.position, to.data(), to.size())) throw Fault(at.position, "cannot be read any more");
        return;
    }
    if (unpacked_ != at.position) {
        unpacked_.reset();
        const Record chunk = record(at.position);
        const ChunkInfo info = chunkInfo(chunk);
        recordsOf(info, chunk.content.subspan(info.records_at - chunk.start - record_header_size), records_);
        unpacked_ = at.position;
    }
    if (at.offset + uint64_t{at.size} > records_.size()) throw Fault(at.position, "the chunk has changed");
    std::copy_n(records_.begin() + at.offset, at.size, to.begin());
}

}  // namespace insonify::mcap
