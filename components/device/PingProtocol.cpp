#include "components/device/PingProtocol.hpp"

#include <numeric>

namespace insonify::device {
namespace {

constexpr size_t header_size = 8, sum_size = 2;

uint16_t sumOf(std::span<const uint8_t> bytes) {
    return static_cast<uint16_t>(std::accumulate(bytes.begin(), bytes.end(), uint32_t{0}));
}

}  // namespace

Bytes PingFrame::bytes() const {
    Bytes bytes = {'B', 'R'};
    bytes.reserve(header_size + payload.size() + sum_size);
    append(bytes, static_cast<uint16_t>(payload.size()));
    append(bytes, message);
    append(bytes, source);
    append(bytes, destination);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    append(bytes, sumOf(bytes));
    return bytes;
}

void PingFrameReader::push(std::span<const uint8_t> bytes) {
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<ptrdiff_t>(begin_));
    begin_ = 0;
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

size_t PingFrameReader::sizeAt(size_t at) const { return header_size + read<uint16_t>(bytes_, at + 2) + sum_size; }

PingFrameReader::Finding PingFrameReader::findingAt(size_t at) const {
    const size_t left = bytes_.size() - at;
    if (bytes_[at] != 'B' || (left > 1 && bytes_[at + 1] != 'R')) return Finding::None;
    if (left < 4) return Finding::Partial;
    const size_t size = sizeAt(at);
    if (size > header_size + max_payload_ + sum_size) return Finding::None;
    if (left < size) return Finding::Partial;
    const auto frame = std::span(bytes_).subspan(at, size);
    return read<uint16_t>(frame, size - sum_size) == sumOf(frame.first(size - sum_size)) ? Finding::Whole
                                                                                         : Finding::None;
}

PingFrame PingFrameReader::take(size_t at) {
    const auto frame = std::span(bytes_).subspan(at, sizeAt(at));
    const auto payload = frame.subspan(header_size, frame.size() - header_size - sum_size);
    begin_ = at + frame.size();
    return {read<uint16_t>(frame, 4), frame[6], frame[7], Bytes(payload.begin(), payload.end())};
}

std::optional<PingFrame> PingFrameReader::next() {
    std::optional<size_t> partial;
    for (size_t at = begin_; at < bytes_.size(); ++at) {
        const Finding finding = findingAt(at);
        if (finding == Finding::Whole) return take(at);
        if (finding == Finding::Partial && !partial) partial = at;
    }
    begin_ = partial.value_or(bytes_.size());
    return {};
}

std::vector<PingFrame> pingFrames(std::span<const uint8_t> datagram, size_t max_payload) {
    PingFrameReader reader(max_payload);
    reader.push(datagram);
    std::vector<PingFrame> frames;
    while (auto frame = reader.next()) frames.push_back(std::move(*frame));
    return frames;
}

void PingPayloadWriter::put(const std::string& text) { payload_.insert(payload_.end(), text.begin(), text.end()); }

void PingPayloadWriter::put(const Bytes& data) {
    append(payload_, static_cast<uint16_t>(data.size()));
    payload_.insert(payload_.end(), data.begin(), data.end());
}

bool PingPayloadReader::has(size_t size) {
    if (!complete_ || payload_.size() - at_ < size) complete_ = false;
    return complete_;
}

void PingPayloadReader::take(std::string& text) {
    if (!complete_) return;
    text.assign(payload_.begin() + static_cast<ptrdiff_t>(at_), payload_.end());
    at_ = payload_.size();
}

void PingPayloadReader::take(Bytes& data) {
    uint16_t size = 0;
    take(size);
    if (!has(size)) return;
    const auto begin = payload_.begin() + static_cast<ptrdiff_t>(at_);
    data.assign(begin, begin + size);
    at_ += size;
}

}  // namespace insonify::device
