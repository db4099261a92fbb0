#pragma once
// Bytes of recordings, made by a published layout.
#include <cstring>
#include <vector>

namespace insonify::test {

using RecordedBytes = std::vector<char>;

template <class T>
void putAt(RecordedBytes& bytes, size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

template <class T>
void putBehind(RecordedBytes& bytes, T value) {
    bytes.resize(bytes.size() + sizeof value);
    putAt(bytes, bytes.size() - sizeof value, value);
}

inline RecordedBytes joinedBytes(const std::vector<RecordedBytes>& parts) {
    RecordedBytes all;
    for (const RecordedBytes& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace insonify::test
