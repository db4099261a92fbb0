#pragma once
#include <type_traits>

#include "components/gpu/Objects.hpp"

namespace insonify::gpu {

/** A list in memory that the processor writes and the device reads, with no call between: a command sees what was
 *  written before it was asked for. Who writes there anew waits first for a fence behind the last command that reads.
 *  Only to be written: for the processor, such memory may be slow to read. */
template <class T>
class UploadList {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    UploadList() = default;
    /** With room for so many, which is all that there ever is. */
    explicit UploadList(size_t room)
        : room_(room),
          buffer_(room * sizeof(T), nullptr, GL_MAP_WRITE_BIT | mapped_for_good),
          items_(static_cast<T*>(buffer_.map(GL_MAP_WRITE_BIT | mapped_for_good))) {}

    size_t room() const { return room_; }
    size_t size() const { return size_; }
    void clear() { size_ = 0; }
    void push_back(const T& item) { items_[size_++] = item; }
    const Buffer& buffer() const { return buffer_; }

private:
    size_t room_ = 0, size_ = 0;
    Buffer buffer_;
    T* items_ = nullptr;
};

}  // namespace insonify::gpu
