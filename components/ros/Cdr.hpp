#pragma once
// The encoding of messages: XCDR1, little endian, after four bytes that name it (00 01 00 00).
//
// Every number is aligned to its size, counted from the end of those four bytes. A string is a u32 length that includes
// a final NUL, then the characters. A sequence is a u32 count, then the elements. A fixed array is the elements alone.
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "types/text/Describe.hpp"

namespace insonify::ros {

template <class T>
concept Message = types::Described<T> && requires {
    T::type_name;
};

/** A truth value in a sequence: std::vector<bool> has no elements to read into. */
enum class Truth : uint8_t { No, Yes };

/** A sequence of at most `max_elements`. */
template <class T, size_t max_elements>
struct Bounded : std::vector<T> {
    using std::vector<T>::vector;
    static constexpr size_t most = max_elements;
};
template <class T>
concept BoundedSequence = requires {
    T::most;
};

/** Whether T is a sequence or an array of fixed length in ROS. */
template <class T>
struct IsSequence : std::false_type {};
template <class T>
struct IsSequence<std::vector<T>> : std::true_type {};
template <class T, size_t most>
struct IsSequence<Bounded<T, most>> : std::true_type {};
template <class T>
struct IsArray : std::false_type {};
template <class T, size_t n>
struct IsArray<std::array<T, n>> : std::true_type {};

template <class T>
concept Sequence = IsSequence<T>::value;
template <class T>
concept Array = IsArray<T>::value;
template <class T>
concept TruthValue = std::is_same_v<T, bool> || std::is_same_v<T, Truth>;
template <class T>
concept Primitive = std::is_arithmetic_v<T> || std::is_same_v<T, std::byte> || TruthValue<T>;

static_assert(std::endian::native == std::endian::little, "numbers are copied in host order");

/** Reports bytes that are not a valid message: the offset from the first byte of the buffer, and the reason. */
struct CdrError : std::runtime_error {
    CdrError(size_t at, const std::string& what)
        : std::runtime_error("byte " + std::to_string(at) + ": " + what), byte(at) {}
    size_t byte;
};

/** Elements whose bytes are the same in memory and in the message. */
template <class T>
concept Block = Primitive<T> && !TruthValue<T>;

/** Returns the min size of an encoded T [B]. */
template <class T>
size_t minimumSize() {
    if constexpr (Message<T>) {
        size_t sum = 0;
        T value{};
        auto add = [&]<class F>(const types::Field&, F&) { sum += minimumSize<F>(); };
        T::describe(value, add);
        return sum;
    } else if constexpr (Array<T>)
        return std::tuple_size_v<T> * minimumSize<typename T::value_type>();
    else if constexpr (Primitive<T>)
        return sizeof(T);
    else
        return sizeof(uint32_t);
}

/** Appends a message to a buffer. */
class CdrWriter {
public:
    explicit CdrWriter(std::vector<char>& bytes) : bytes_(bytes) {
        bytes_.resize(bytes_.size() + 4);  // 0 1 0 0: little endian
        bytes_[bytes_.size() - 3] = 1;
        start_ = bytes_.size();
    }

    template <class T>
    void value(const T& item) {
        if constexpr (Message<T>) {
            auto visit = [&](const types::Field&, const auto& field) { value(field); };
            T::describe(item, visit);
        } else if constexpr (std::is_same_v<T, std::string>) {
            value(static_cast<uint32_t>(item.size() + 1));
            raw(item.c_str(), item.size() + 1);
        } else if constexpr (Sequence<T>) {
            value(static_cast<uint32_t>(item.size()));
            elements(item);
        } else if constexpr (Array<T>)
            elements(item);
        else {
            align(sizeof(T));
            raw(&item, sizeof(T));
        }
    }

private:
    template <class Items>
    void elements(const Items& items) {
        using Item = typename Items::value_type;
        if constexpr (Block<Item>) {
            if (items.empty()) return;
            align(sizeof(Item));
            raw(items.data(), items.size() * sizeof(Item));
        } else
            for (const Item& item : items) value(item);
    }
    void align(size_t size) { bytes_.resize(bytes_.size() + (start_ - bytes_.size()) % size); }
    void raw(const void* data, size_t size) {
        const char* first = static_cast<const char*>(data);
        bytes_.insert(bytes_.end(), first, first + size);
    }

    std::vector<char>& bytes_;
    size_t start_;  ///< Origin of the alignment.
};

/** Decodes a message from a buffer. Throws CdrError for invalid bytes. Counts are checked against the bytes that are
 *  left. */
class CdrReader {
public:
    explicit CdrReader(std::span<const char> bytes);

    template <class T>
    void value(T& item) {
        if constexpr (Message<T>) {
            auto visit = [&](const types::Field&, auto& field) { value(field); };
            T::describe(item, visit);
        } else if constexpr (std::is_same_v<T, std::string>)
            text(item);
        else if constexpr (TruthValue<T>)
            item = static_cast<T>(truth());
        else if constexpr (Sequence<T>) {
            const uint32_t size = count(minimumSize<typename T::value_type>());
            if constexpr (BoundedSequence<T>) refuseMore(size, T::most);
            item.resize(size);
            elements(item);
        } else if constexpr (Array<T>)
            elements(item);
        else {
            align(sizeof(T));
            raw(&item, sizeof(T));
        }
    }

    /** Throws if more is left than padding to a multiple of four bytes, which some writers append. */
    void finish() const;

private:
    template <class Items>
    void elements(Items& items) {
        using Item = typename Items::value_type;
        if constexpr (Block<Item>) {
            if (items.empty()) return;
            align(sizeof(Item));
            raw(items.data(), items.size() * sizeof(Item));
        } else
            for (Item& item : items) value(item);
    }
    void align(size_t size);
    void raw(void* to, size_t size);
    void text(std::string& item);
    bool truth();
    uint32_t count(size_t min_size);
    void refuseMore(uint32_t size, size_t most) const;

    std::span<const char> bytes_;
    size_t at_ = 4;
};

/** Appends the message's bytes to `bytes`. */
template <Message T>
void encode(const T& message, std::vector<char>& bytes) {
    CdrWriter(bytes).value(message);
}

/** Fills `message` and reuses its memory. Throws CdrError unless `bytes` is exactly one message. */
template <Message T>
void decode(std::span<const char> bytes, T& message) {
    CdrReader reader(bytes);
    reader.value(message);
    reader.finish();
}

}  // namespace insonify::ros
