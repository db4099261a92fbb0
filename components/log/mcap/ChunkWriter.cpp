#include "components/log/mcap/ChunkWriter.hpp"

#include <zlib.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "types/Check.hpp"

namespace insonify::log::mcap {
namespace {

constexpr size_t chunk_size = 1 << 20;                                        // [B]
constexpr size_t chunk_header_size = record_header_size + 3 * 8 + 4 + 4 + 8;  // header of an uncompressed chunk [B]
constexpr size_t max_ids = std::numeric_limits<uint16_t>::max();

uint32_t crc(const char* data, size_t size, uint32_t before = 0) {
    return static_cast<uint32_t>(crc32_z(before, reinterpret_cast<const Bytef*>(data), size));
}

}  // namespace

ChunkWriter::ChunkWriter(std::filesystem::path path) {
    summary_.path = std::move(path);
    open();
}

ChunkWriter::~ChunkWriter() {
    if (isEmpty()) return;
    try {
        close();
    } catch (const std::exception&) {
        // A destructor cannot report errors; flush() and close() do.
    }
}

void ChunkWriter::open() {
    file_.emplace(summary_.path);
    crc_ = 0;
    head_.clear();
    RecordWriter out(head_);
    out.raw(magic);
    out.begin(Op::Header);
    out.text("ros2");
    out.text("insonify");
    out.end();
    openChunk();
    for (const auto& [name, texts] : metadata_) putMetadata(name, texts);
    RecordWriter records(chunk_);
    for (size_t i = 0; i < schemas_.size(); ++i) putSchema(records, i);
    for (size_t i = 0; i < channels_.size(); ++i) putChannel(records, i);
}

void ChunkWriter::append(const std::vector<char>& bytes) {
    if (const std::vector<char> head = std::exchange(head_, {}); !head.empty()) append(head);
    file_->append(bytes.data(), bytes.size());
    crc_ = crc(bytes.data(), bytes.size(), crc_);
}

void ChunkWriter::putSchema(RecordWriter& out, size_t number) const {
    const Schema& schema = schemas_[number];
    out.begin(Op::Schema);
    out.number(static_cast<uint16_t>(number + 1));
    for (const std::string* text : {&schema.name, &schema.encoding, &schema.text}) out.text(*text);
    out.end();
}

void ChunkWriter::putChannel(RecordWriter& out, size_t number) const {
    const Channel& channel = channels_[number];
    out.begin(Op::Channel);
    out.number(static_cast<uint16_t>(number));
    out.number(channel.schema);
    out.text(channel.topic);
    out.text(channel.encoding);
    out.texts(channel.metadata);
    out.end();
}

uint16_t ChunkWriter::addSchema(Schema schema) {
    if (schemas_.size() == max_ids) throw std::length_error("an MCAP file holds at most 65535 schemas");
    schemas_.push_back(std::move(schema));
    RecordWriter out(chunk_);
    putSchema(out, schemas_.size() - 1);
    return static_cast<uint16_t>(schemas_.size());
}

uint16_t ChunkWriter::addChannel(Channel channel) {
    if (channels_.size() == max_ids) throw std::length_error("an MCAP file holds at most 65535 channels");
    channels_.push_back(std::move(channel));
    index_.resize(channels_.size());
    summary_.counts.resize(channels_.size());
    RecordWriter out(chunk_);
    putChannel(out, channels_.size() - 1);
    return static_cast<uint16_t>(channels_.size() - 1);
}

void ChunkWriter::addMetadata(const std::string& name, const Texts& texts) {
    flush();
    metadata_.emplace_back(name, texts);
    putMetadata(name, texts);
}

void ChunkWriter::putMetadata(const std::string& name, const Texts& texts) {
    std::vector<char> bytes;
    RecordWriter out(bytes);
    out.begin(Op::Metadata);
    out.text(name);
    out.texts(texts);
    out.end();
    metadata_index_.push_back({position(), bytes.size(), name});
    if (head_.empty())
        append(bytes);
    else
        head_.insert(head_.end(), bytes.begin(), bytes.end());
}

void ChunkWriter::write(uint16_t channel, uint64_t log_ns, uint64_t publish_ns, std::span<const char> bytes,
                        Counts counts) {
    if (!isOpen()) throw std::runtime_error(path().string() + ": the log is closed");
    chunk_first_ns_ = chunk_messages_ == 0 ? log_ns : std::min(chunk_first_ns_, log_ns);
    chunk_last_ns_ = chunk_messages_ == 0 ? log_ns : std::max(chunk_last_ns_, log_ns);
    ++chunk_messages_;
    if (counts == Counts::Yes) ++chunk_counted_;
    index_.at(channel).push_back({log_ns, chunk_.size() - chunk_header_size});
    RecordWriter out(chunk_);
    out.begin(Op::Message);
    out.number(channel);
    out.number(static_cast<uint32_t>(summary_.counts[channel]++));
    out.number(log_ns);
    out.number(publish_ns);
    out.raw({bytes.data(), bytes.size()});
    out.end();
    if (chunk_.size() >= chunk_size) flush();
}

void ChunkWriter::openChunk() {
    chunk_.clear();
    chunk_.resize(chunk_header_size);
    chunk_first_ns_ = chunk_last_ns_ = chunk_messages_ = chunk_counted_ = 0;
    for (auto& entries : index_) entries.clear();
}

/** Fills in the chunk's header and appends the indices of its messages. */
void ChunkWriter::closeChunk(ChunkIndex& index) {
    const uint64_t size = chunk_.size() - chunk_header_size;
    index = {chunk_first_ns_, chunk_last_ns_, position(), chunk_.size(), size, {}, 0};
    std::vector<char> header;
    RecordWriter head(header);
    head.begin(Op::Chunk);
    head.number(chunk_first_ns_);
    head.number(chunk_last_ns_);
    head.number(size);
    head.number(crc(chunk_.data() + chunk_header_size, size));
    head.text("");
    head.number(size);
    head.end();
    const uint64_t length = chunk_.size() - record_header_size;
    INSONIFY_CHECK(header.size() == chunk_header_size, header.size(), chunk_header_size);
    INSONIFY_CHECK(chunk_.size() >= chunk_header_size, chunk_.size());
    std::memcpy(header.data() + 1, &length, sizeof length);
    std::ranges::copy(header, chunk_.begin());

    RecordWriter out(chunk_);
    for (size_t channel = 0; channel < index_.size(); ++channel) {
        if (index_[channel].empty()) continue;
        index.indices.emplace_back(static_cast<uint16_t>(channel), index.start + chunk_.size());
        out.begin(Op::MessageIndex);
        out.number(static_cast<uint16_t>(channel));
        out.sized([&] {
            for (const IndexEntry& entry : index_[channel]) out.number(entry);
        });
        out.end();
    }
    index.indices_length = chunk_.size() - index.length;
}

void ChunkWriter::flush() {
    if (!isOpen() || chunk_.size() == chunk_header_size) return;
    ChunkIndex index;
    closeChunk(index);
    append(chunk_);
    chunks_.push_back(std::move(index));
    if (chunk_messages_ > 0) {
        summary_.first_ns = summary_.messages == 0 ? chunk_first_ns_ : std::min(summary_.first_ns, chunk_first_ns_);
        summary_.last_ns = std::max(summary_.last_ns, chunk_last_ns_);
    }
    summary_.messages += chunk_messages_;
    kept_ += chunk_counted_;
    openChunk();
}

void ChunkWriter::putStatistics(RecordWriter& out) const {
    out.begin(Op::Statistics);
    out.number(summary_.messages);
    out.number(static_cast<uint16_t>(schemas_.size()));
    out.number(static_cast<uint32_t>(channels_.size()));
    out.number(uint32_t{0});  // attachments
    out.number(static_cast<uint32_t>(metadata_index_.size()));
    out.number(static_cast<uint32_t>(chunks_.size()));
    out.number(summary_.first_ns);
    out.number(summary_.last_ns);
    out.sized([&] {
        for (size_t channel = 0; channel < channels_.size(); ++channel) {
            out.number(static_cast<uint16_t>(channel));
            out.number(summary_.counts[channel]);
        }
    });
    out.end();
}

void ChunkWriter::putChunkIndex(RecordWriter& out, const ChunkIndex& index) const {
    out.begin(Op::ChunkIndex);
    for (const uint64_t number : {index.first_ns, index.last_ns, index.start, index.length}) out.number(number);
    out.sized([&] {
        for (const auto& [channel, place] : index.indices) {
            out.number(channel);
            out.number(place);
        }
    });
    out.number(index.indices_length);
    out.text("");
    out.number(index.size);
    out.number(index.size);
    out.end();
}

/** Writes the summary, offsets and footer, behind the end of the data. */
std::vector<char> ChunkWriter::summaryBytes() const {
    std::vector<char> bytes;
    RecordWriter out(bytes);
    struct Group {
        Op op;
        uint64_t from, to;
    };
    std::vector<Group> groups;
    const uint64_t start = file_->size();
    const auto group = [&](Op op, const std::function<void()>& fill) {
        const uint64_t from = bytes.size();
        fill();
        if (bytes.size() > from) groups.push_back({op, start + from, start + bytes.size()});
    };
    group(Op::Schema, [&] {
        for (size_t i = 0; i < schemas_.size(); ++i) putSchema(out, i);
    });
    group(Op::Channel, [&] {
        for (size_t i = 0; i < channels_.size(); ++i) putChannel(out, i);
    });
    group(Op::Statistics, [&] { putStatistics(out); });
    group(Op::ChunkIndex, [&] {
        for (const ChunkIndex& index : chunks_) putChunkIndex(out, index);
    });
    group(Op::MetadataIndex, [&] {
        for (const MetadataIndex& index : metadata_index_) {
            out.begin(Op::MetadataIndex);
            out.number(index.start);
            out.number(index.length);
            out.text(index.name);
            out.end();
        }
    });
    const uint64_t offsets = start + bytes.size();
    for (const Group& each : groups) {
        out.begin(Op::SummaryOffset);
        out.number(each.op);
        out.number(each.from);
        out.number(each.to - each.from);
        out.end();
    }
    out.begin(Op::Footer);
    out.number(start);
    out.number(offsets);
    const uint64_t length = 8 + 8 + 4;
    std::memcpy(bytes.data() + bytes.size() - 24, &length, sizeof length);
    out.number(crc(bytes.data(), bytes.size()));
    out.raw(magic);
    return bytes;
}

void ChunkWriter::sync() {
    flush();
    if (isOpen()) file_->sync();
}

void ChunkWriter::close() {
    if (!isOpen()) return;
    flush();
    std::vector<char> end;
    RecordWriter out(end);
    out.begin(Op::DataEnd);
    out.number(crc_);
    out.end();
    append(end);
    append(summaryBytes());
    file_->close();
}

void ChunkWriter::discard() {
    for (size_t channel = 0; channel < index_.size(); ++channel) summary_.counts[channel] -= index_[channel].size();
    openChunk();
}

void ChunkWriter::next(std::filesystem::path path) {
    close();
    summary_ = {std::move(path), 0, 0, 0, std::vector<uint64_t>(channels_.size())};
    metadata_index_.clear();
    chunks_.clear();
    open();
}

}  // namespace insonify::log::mcap
