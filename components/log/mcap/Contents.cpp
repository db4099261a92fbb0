#include "components/log/mcap/Contents.hpp"

#include <algorithm>
#include <limits>

#include "types/text/ConfigError.hpp"

namespace insonify::log::mcap {
namespace {

class SummaryCheck {
public:
    SummaryCheck(File& file, const Contents& data) : file_(file), data_(data), at_(data.read_to) {}

    void run() {
        dataEnd(next());
        start_ = at_;
        File::Record record = next();
        for (; record.op != Op::Footer; record = next()) {
            if (record.op == Op::SummaryOffset && offsets_ == 0) offsets_ = record.start;
            RecordReader reader = record.reader();
            entry(record, reader);
            crc_ = checksum(record.content, checksum(record.header, crc_));
            groups_[record.op].push_back({record.start, record.end()});
        }
        footer(record);
    }

private:
    struct Extent {
        uint64_t from, to;
    };

    File::Record next() {
        File::Record record = file_.record(at_);
        at_ = record.end();
        return record;
    }

    static void require(bool right, uint64_t at, const char* what) {
        if (!right) throw FormatError(at, what);
    }

    void dataEnd(const File::Record& record) const {
        const auto crc = record.reader().number<uint32_t>();
        require(record.content.size() == sizeof crc, record.start, "the end of the data is not a record of that kind");
        if (crc != 0 && crc != data_.crc)
            throw FormatError(
                record.start + record_header_size,
                "the checksum of the data is " + std::to_string(data_.crc) + ", and must be " + std::to_string(crc));
    }

    void entry(const File::Record& record, RecordReader& reader) {
        const uint64_t at = reader.at();
        if (record.op == Op::Schema)
            require(isKnownSchema(reader), at, "the summary has a schema that is not in the data");
        else if (record.op == Op::Channel)
            require(isKnownChannel(reader), at, "the summary has a channel that is not in the data");
        else if (record.op == Op::Statistics)
            statistics(reader);
        else if (record.op == Op::ChunkIndex)
            chunkIndex(reader);
        else if (record.op == Op::MetadataIndex)
            metadataIndex(reader);
        else if (record.op == Op::SummaryOffset)
            summaryOffset(reader);
        else
            require(record.op == Op::AttachmentIndex || record.op > Op::DataEnd, record.start,
                    "a record of this kind is not allowed in the summary");
    }

    bool isKnownSchema(RecordReader& reader) const {
        const auto found = data_.schemas.find(reader.number<uint16_t>());
        if (found == data_.schemas.end()) return false;
        const Schema& schema = found->second;
        return reader.text() == schema.name && reader.text() == schema.encoding && reader.text() == schema.text;
    }

    bool isKnownChannel(RecordReader& reader) const {
        const auto found = data_.channels.find(reader.number<uint16_t>());
        if (found == data_.channels.end()) return false;
        const Channel& channel = found->second;
        return reader.number<uint16_t>() == channel.schema && reader.text() == channel.topic &&
               reader.text() == channel.encoding && reader.texts() == channel.metadata;
    }

    void statistics(RecordReader& reader) const {
        const auto expect = [&]<class T>(T number, const char* what) {
            const uint64_t at = reader.at();
            require(reader.number<T>() == number, at, what);
        };
        const auto& messages = data_.messages;
        expect(uint64_t{messages.size()}, "the summary has another number of messages");
        expect(static_cast<uint16_t>(data_.schemas.size()), "the summary has another number of schemas");
        expect(static_cast<uint32_t>(data_.channels.size()), "the summary has another number of channels");
        expect(data_.attachments, "the summary has another number of attachments");
        expect(static_cast<uint32_t>(data_.metadata.size()), "the summary has another number of metadata");
        expect(static_cast<uint32_t>(data_.chunks.size()), "the summary has another number of chunks");
        const auto [first, last] = std::ranges::minmax_element(messages, {}, &MessageRef::log_ns);
        expect(messages.empty() ? uint64_t{0} : first->log_ns, "the summary has another first message");
        expect(messages.empty() ? uint64_t{0} : last->log_ns, "the summary has another last message");
        std::map<uint16_t, uint64_t> counts;
        for (const MessageRef& message : messages) ++counts[message.channel];
        for (RecordReader all = reader.part(); all.left() > 0;) {
            const uint64_t at = all.at();
            const auto channel = all.number<uint16_t>();
            const auto count = all.number<uint64_t>();
            const auto found = counts.find(channel);
            require(count == (found == counts.end() ? 0 : found->second) && data_.channels.contains(channel), at,
                    "the summary has another number of messages of a channel");
        }
    }

    void chunkIndex(RecordReader& reader) const {
        const uint64_t at = reader.at();
        const auto first = reader.number<uint64_t>(), last = reader.number<uint64_t>();
        const auto start = reader.number<uint64_t>(), length = reader.number<uint64_t>();
        const auto chunk = std::ranges::find(data_.chunks, start, &ChunkInfo::start);
        require(chunk != data_.chunks.end() && chunk->length == length && chunk->first_ns == first &&
                    chunk->last_ns == last,
                at, "the summary has a chunk that is not in the file");
        for (RecordReader indices = reader.part(); indices.left() > 0;) {
            const uint64_t place = indices.at();
            indices.number<uint16_t>();
            const auto index = indices.number<uint64_t>();
            require(index >= start + length && index < data_.read_to, place,
                    "the summary has an index of messages that is not in the file");
        }
        reader.number<uint64_t>();
        require(reader.text() == chunk->compression && reader.number<uint64_t>() == chunk->records_size &&
                    reader.number<uint64_t>() == chunk->size,
                at, "the summary has a chunk of another size");
    }

    void metadataIndex(RecordReader& reader) const {
        const uint64_t at = reader.at();
        const auto start = reader.number<uint64_t>(), length = reader.number<uint64_t>();
        const auto found = std::ranges::find(data_.metadata, start, &Contents::Metadata::start);
        require(found != data_.metadata.end() && found->length == length && found->name == reader.text(), at,
                "the summary has metadata that is not in the file");
    }

    void summaryOffset(RecordReader& reader) {
        const uint64_t at = reader.at();
        const auto group = groups_.find(reader.number<Op>());
        const auto from = reader.number<uint64_t>(), length = reader.number<uint64_t>();
        const bool right = group == groups_.end()
                               ? length == 0  // some writers list empty groups
                               : group->second.front().from == from && group->second.back().to == from + length;
        require(right, at, "the summary's offsets are wrong");
    }

    void footer(const File::Record& record) {
        RecordReader reader = record.reader();
        require(record.content.size() == 20, record.start, "the footer has another size than 20 bytes");
        const bool has_summary = record.start > start_;
        const auto start = reader.number<uint64_t>(), offsets = reader.number<uint64_t>();
        require(start == (has_summary ? start_ : 0), record.start + record_header_size,
                "the footer has another place of the summary");
        require(offsets == offsets_ || offsets == 0, record.start + record_header_size + 8,
                "the footer has another place of the offsets");
        crc_ = checksum(record.content.first(16), checksum(record.header, crc_));
        const uint64_t at = reader.at();
        const auto crc = reader.number<uint32_t>();
        require(crc == 0 || crc == crc_, at, "the checksum of the summary is wrong");
        file_.expectEnd(record.end());
    }

    File& file_;
    const Contents& data_;
    uint64_t at_, start_ = 0, offsets_ = 0;
    uint32_t crc_ = 0;
    std::map<Op, std::vector<Extent>> groups_;
};

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
            records(getRecords(chunk, record.content.subspan(inside), unpacked_));
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

void checkSummary(File& file, const Contents& contents) { SummaryCheck(file, contents).run(); }

bool File::hasMagic(uint64_t at) const {
    char bytes[magic.size()];
    return file_.read(at, bytes, sizeof bytes) && std::string_view(bytes, sizeof bytes) == magic;
}

void File::expectEnd(uint64_t at) const {
    if (size() - at < magic.size()) throw FormatError(size(), "the file ends within its last eight bytes");
    if (!hasMagic(at)) throw FormatError(at, "the file does not end as an MCAP file");
    if (size() > at + magic.size()) throw FormatError(at + magic.size(), "the file continues after its end");
}

File::Record File::record(uint64_t at) {
    Record record{.start = at};
    if (at == size()) throw FormatError(at, "the file ends here, without a footer");
    if (at > size() || size() - at < record.header.size() ||
        !file_.read(at, record.header.data(), record.header.size()))
        throw FormatError(size(), "the file ends within a record");
    uint64_t length = 0;
    std::memcpy(&length, record.header.data() + 1, sizeof length);
    if (length > size() - at - record.header.size())
        throw FormatError(size(), "the file ends within a record of " + std::to_string(length) + " bytes");
    content_.resize(length);
    if (!file_.read(at + record.header.size(), content_.data(), length))
        throw FormatError(at, "a record cannot be read");
    record.op = static_cast<Op>(record.header[0]);
    record.content = content_;
    return record;
}

void File::read(const MessageRef& at, std::vector<char>& to) {
    to.resize(at.size);
    if (!at.compressed) {
        if (!file_.read(at.position, to.data(), to.size())) throw FormatError(at.position, "cannot be read any more");
        return;
    }
    if (unpacked_ != at.position) {
        unpacked_.reset();
        const Record chunk = record(at.position);
        const ChunkInfo info = chunkInfo(chunk);
        getRecords(info, chunk.content.subspan(info.records_at - chunk.start - record_header_size), records_);
        unpacked_ = at.position;
    }
    if (at.offset + uint64_t{at.size} > records_.size()) throw FormatError(at.position, "the chunk has changed");
    std::copy_n(records_.begin() + at.offset, at.size, to.begin());
}

std::optional<std::pair<Op, uint64_t>> File::header(uint64_t at) const {
    char bytes[record_header_size];
    if (!file_.read(at, bytes, sizeof bytes)) return {};
    uint64_t length = 0;
    std::memcpy(&length, bytes + 1, sizeof length);
    const auto op = static_cast<Op>(bytes[0]);
    const uint64_t left = size() - at - sizeof bytes;
    if (op < Op::Header || op > Op::DataEnd || length > left) return {};
    return std::pair(op, at + sizeof bytes + length);
}

bool File::looksLikeRecord(uint64_t at) const {
    if (at == size() || hasMagic(at)) return true;
    const auto found = header(at);
    Op next{};
    return found && (!file_.read(found->second, &next, sizeof next) || (next >= Op::Header && next <= Op::DataEnd) ||
                     hasMagic(found->second));
}

uint64_t File::nextRecord(uint64_t position) const {
    std::vector<char> window(1 << 20);
    for (; position + record_header_size <= size(); position += window.size()) {
        const size_t length = std::min<uint64_t>(window.size(), size() - position);
        if (!file_.read(position, window.data(), length)) break;
        for (size_t i = 0; i < length; ++i)
            if (window[i] >= 1 && window[i] <= static_cast<char>(Op::DataEnd) && header(position + i) &&
                looksLikeRecord(position + i))
                return position + i;
    }
    return size();
}

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
