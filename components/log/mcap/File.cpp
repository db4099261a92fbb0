// An open file, read record by record.
#include <algorithm>

#include "components/log/mcap/Contents.hpp"

namespace insonify::log::mcap {

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
        recordsOf(info, chunk.content.subspan(info.records_at - chunk.start - record_header_size), records_);
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

}  // namespace insonify::log::mcap
