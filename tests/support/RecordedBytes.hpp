#pragma once
// Bytes of recordings, made by a published layout.
#include <cstring>
#include <vector>

namespace insonify::test {

using RecordedBytes = std::vector<char>;

void putAt(RecordedBytes& bytes, size_t at, auto value) { std::memcpy(bytes.data() + at, &value, sizeof value); }

void putBehind(RecordedBytes& bytes, auto value) {
    bytes.resize(bytes.size() + sizeof value);
    putAt(bytes, bytes.size() - sizeof value, value);
}

inline RecordedBytes joinedBytes(const std::vector<RecordedBytes>& parts) {
    RecordedBytes all;
    for (const RecordedBytes& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace insonify::test
