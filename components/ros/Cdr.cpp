#include "components/ros/Cdr.hpp"

namespace insonify::ros {

CdrReader::CdrReader(std::span<const char> bytes) : bytes_(bytes) {
    if (bytes.size() < 4) throw CdrError(bytes.size(), "a message begins with four bytes that name its encoding");
    if (bytes[0] != 0 || bytes[1] != 1)
        throw CdrError(0, "encoding " +
                              std::to_string(static_cast<uint8_t>(bytes[0]) << 8 | static_cast<uint8_t>(bytes[1])) +
                              " is not read, only 1: plain CDR, little endian");
}

void CdrReader::finish() const {
    const size_t left = bytes_.size() - at_;
    if (left > 3) throw CdrError(at_, "the message has " + std::to_string(left) + " bytes too many");
}

void CdrReader::align(size_t size) {
    const size_t padding = (4 - at_) % size;
    if (padding > bytes_.size() - at_) throw CdrError(bytes_.size(), "the message ends within padding");
    at_ += padding;
}

void CdrReader::raw(void* to, size_t size) {
    if (size > bytes_.size() - at_) throw CdrError(bytes_.size(), "the message ends within a value");
    std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
}

uint32_t CdrReader::count(size_t min_size) {
    uint32_t wanted = 0;
    value(wanted);
    if (wanted > (bytes_.size() - at_) / min_size)
        throw CdrError(at_ - sizeof wanted,
                       std::to_string(wanted) + " elements are announced, more than the message holds");
    return wanted;
}

void CdrReader::refuseMore(uint32_t size, size_t most) const {
    if (size > most)
        throw CdrError(at_ - sizeof size, std::to_string(size) + " elements are announced, at most " +
                                              std::to_string(most) + " are allowed");
}

void CdrReader::text(std::string& item) {
    const uint32_t size = count(1);
    item.assign(bytes_.data() + at_, size);
    at_ += size;
    if (size == 0) return;  // some writers send an empty text without NUL
    if (item.back() != '\0') throw CdrError(at_ - 1, "a text does not end in NUL");
    item.pop_back();
}

bool CdrReader::truth() {
    uint8_t byte = 0;
    value(byte);
    if (byte > 1) throw CdrError(at_ - 1, "a truth value is " + std::to_string(byte) + ", not 0 or 1");
    return byte == 1;
}

}  // namespace insonify::ros
