#include "components/mavlink/Frame.hpp"

#include <algorithm>

namespace insonify::mavlink {
namespace {

constexpr uint8_t magic_1 = 0xfe, magic_2 = 0xfd;
constexpr size_t header_1 = 6, header_2 = 10, sum_size = 2, signature_size = 13;  // [bytes]
constexpr uint8_t is_signed = 1;                                                  // an incompatibility flag

/** Sizes of the parts of a frame [bytes]. */
struct Extent {
    size_t header, payload;
    size_t signature = 0;
    uint8_t flags = 0;  ///< Incompatibility flags.
    size_t sum() const { return header + payload; }
    size_t whole() const { return sum() + sum_size + signature; }
};

/** Returns the sizes of the frame that begins with the first byte; none when the bytes end within the frame. */
std::optional<Extent> getExtent(std::span<const uint8_t> bytes) {
    if (bytes.size() < header_1) return {};
    if (bytes[0] == magic_1) {
        const Extent extent{header_1, bytes[1]};
        return extent.whole() <= bytes.size() ? std::optional(extent) : std::nullopt;
    }
    const Extent extent{header_2, bytes[1], bytes[2] & is_signed ? signature_size : 0, bytes[2]};
    return extent.whole() <= bytes.size() ? std::optional(extent) : std::nullopt;
}

Frame getFrame(std::span<const uint8_t> bytes, const Extent& extent) {
    const auto payload = bytes.subspan(extent.header, extent.payload);
    Frame frame{.payload = {payload.begin(), payload.end()}};
    if (bytes[0] == magic_1) {
        frame.version = 1;
        frame.sequence = bytes[2];
        frame.system = bytes[3];
        frame.component = bytes[4];
        frame.message = bytes[5];
    } else {
        frame.sequence = bytes[4];
        frame.system = bytes[5];
        frame.component = bytes[6];
        frame.message = bytes[7] | uint32_t{bytes[8]} << 8 | uint32_t{bytes[9]} << 16;
    }
    return frame;
}

uint16_t computeSum(std::span<const uint8_t> behind_magic, uint8_t crc_extra) {
    return crc(std::span(&crc_extra, 1), crc(behind_magic));
}

bool addsUp(std::span<const uint8_t> bytes, const Extent& extent, uint8_t crc_extra) {
    return device::read<uint16_t>(bytes, extent.sum()) == computeSum(bytes.subspan(1, extent.sum() - 1), crc_extra);
}

/** Reads the frames of a datagram in order. */
class DatagramReader {
public:
    DatagramReader(std::span<const uint8_t> bytes, std::span<const Kind> kinds) : bytes_(bytes), kinds_(kinds) {}

    Datagram read() {
        while (!bytes_.empty()) bytes_ = bytes_.subspan(step());
        return std::move(found_);
    }

private:
    /** Reads a frame, if there is one, and returns the number of bytes to skip. */
    size_t step() {
        if (bytes_[0] != magic_1 && bytes_[0] != magic_2) return refuse("bytes that are no frame", 1);
        const auto extent = getExtent(bytes_);
        if (!extent) return refuse("a frame that is cut off", 1);
        if ((extent->flags & ~is_signed) != 0) return refuse("a frame with unknown flags", extent->whole());
        Frame frame = getFrame(bytes_, *extent);
        const auto kind = std::ranges::find(kinds_, frame.message, &Kind::message);
        if (kind == kinds_.end()) return extent->whole();
        if (!addsUp(bytes_, *extent, kind->crc_extra)) return refuse("a frame with a wrong checksum", 1);
        if (frame.version == 1 && frame.payload.size() != kind->size)
            return refuse("a frame with a wrong length for its message", extent->whole());
        found_.frames.push_back(std::move(frame));
        return extent->whole();
    }
    size_t refuse(const char* what, size_t size) {
        if (found_.diagnostic.empty()) found_.diagnostic = what;
        return size;
    }

    std::span<const uint8_t> bytes_;  ///< Remaining bytes.
    std::span<const Kind> kinds_;
    Datagram found_;
};

}  // namespace

uint16_t crc(std::span<const uint8_t> bytes, uint16_t from) {
    for (const uint8_t byte : bytes) {
        uint8_t mixed = static_cast<uint8_t>(byte ^ (from & 0xff));
        mixed = static_cast<uint8_t>(mixed ^ (mixed << 4));
        from = static_cast<uint16_t>((from >> 8) ^ (mixed << 8) ^ (mixed << 3) ^ (mixed >> 4));
    }
    return from;
}

Bytes Frame::bytes(uint8_t crc_extra) const {
    size_t size = std::min<size_t>(payload.size(), 255);
    while (version == 2 && size > 1 && payload[size - 1] == 0) --size;
    Bytes all;
    if (version == 1)
        all = {magic_1, static_cast<uint8_t>(size), sequence, system, component, static_cast<uint8_t>(message)};
    else
        all = {magic_2,
               static_cast<uint8_t>(size),
               0,
               0,
               sequence,
               system,
               component,
               static_cast<uint8_t>(message),
               static_cast<uint8_t>(message >> 8),
               static_cast<uint8_t>(message >> 16)};
    all.insert(all.end(), payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size));
    device::append(all, computeSum(std::span<const uint8_t>(all).subspan(1), crc_extra));
    return all;
}

Datagram readDatagram(std::span<const uint8_t> bytes, std::span<const Kind> kinds) {
    return DatagramReader(bytes, kinds).read();
}

}  // namespace insonify::mavlink
