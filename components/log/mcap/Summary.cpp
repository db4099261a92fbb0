// Compares the summary and footer of a file with its data.
#include <algorithm>

#include "components/log/mcap/Contents.hpp"

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

}  // namespace

void checkSummary(File& file, const Contents& contents) { SummaryCheck(file, contents).run(); }

}  // namespace insonify::log::mcap
