#include "components/device/ping/PingProtocol.hpp"

#include <numeric>

#include "types/Check.hpp"

namespace insonify::device {
namespace {

constexpr size_t header_size = 8, sum_size = 2;

uint16_t computeSum(std::span<const uint8_t> bytes) {
    return static_cast<uint16_t>(std::accumulate(bytes.begin(), bytes.end(), uint32_t{0}));
}

}  // namespace

Bytes PingFrame::bytes() const {
    INSONIFY_CHECK(payload.size() <= UINT16_MAX, payload.size());
    Bytes bytes = {'B', 'R'};
    bytes.reserve(header_size + payload.size() + sum_size);
    append(bytes, static_cast<uint16_t>(payload.size()));
    append(bytes, message);
    append(bytes, source);
    append(bytes, destination);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    append(bytes, computeSum(bytes));
    return bytes;
}

size_t PingFrameReader::getSize(std::span<const uint8_t> bytes) const {
    constexpr size_t with_length = 4;
    if (bytes[0] != 'B' || (bytes.size() > 1 && bytes[1] != 'R')) return 0;
    if (bytes.size() < with_length) return with_length;
    const size_t payload = read<uint16_t>(bytes, 2), size = header_size + payload + sum_size;
    if (payload > max_payload_) return 0;
    if (size > bytes.size()) return size;
    return read<uint16_t>(bytes, size - sum_size) == computeSum(bytes.first(size - sum_size)) ? size : 0;
}

std::optional<PingFrame> PingFrameReader::next() {
    const auto frame = nextFrame();
    if (frame.empty()) return {};
    const auto payload = frame.subspan(header_size, frame.size() - header_size - sum_size);
    return PingFrame{read<uint16_t>(frame, 4), frame[6], frame[7], Bytes(payload.begin(), payload.end())};
}

std::vector<PingFrame> pingFrames(std::span<const uint8_t> datagram, size_t max_payload) {
    PingFrameReader reader(max_payload);
    reader.add(datagram);
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
