#pragma once
// The bytes of a described type in a log, as typelib marshals it.
//
// Fields follow one another as in memory, with the padding between them. Padding after the last field of the whole
// sample is dropped; padding after a vector's element is kept. Vectors and strings are a u64 count and their elements.
#include <bit>
#include <cstring>

#include "components/log/Stream.hpp"
#include "components/log/pocolog/Typelib.hpp"
#include "types/geometry/Angle.hpp"

namespace insonify::log::pocolog {

static_assert(std::endian::native == std::endian::little,
              "samples are copied in host order, which must be little endian");

/** Elements with the same bytes on the wire and in memory, so that a vector of them is one block. */
template <class T>
concept Bulk =
    (Numeric<T> && !std::is_same_v<T, bool>) || std::is_same_v<T, types::Time> || std::is_same_v<T, types::Angle>;

/** The min number of bytes of a T on the wire [B]. */
template <class T>
size_t minimumSize() {
    if constexpr (Text<T> || Vector<T>)
        return sizeof(uint64_t);
    else if constexpr (types::Described<T>) {
        static const size_t size = [] {
            size_t sum = 0;
            forEachField<T>([&]<class F>(const types::Field&, F&) { sum += minimumSize<F>(); });
            return sum;
        }();
        return size;
    } else
        return sizeof(T);
}

/** Appends to a byte buffer. */
class Encoder {
public:
    explicit Encoder(std::vector<char>& bytes) : bytes_(bytes) {}

    void bytes(const void* data, size_t size) {
        const char* first = static_cast<const char*>(data);
        bytes_.insert(bytes_.end(), first, first + size);
    }
    void zeros(size_t size) { bytes_.resize(bytes_.size() + size); }
    void count(const auto& items) { scalar(static_cast<uint64_t>(items.size())); }
    void scalar(const auto& value) { bytes(&value, sizeof value); }
    template <class T>
    void block(const std::vector<T>& items) {
        bytes(items.data(), items.size() * sizeof(T));
    }

private:
    std::vector<char>& bytes_;
};

/** Reads from a byte buffer; throws FormatError where it ends too early. */
class Decoder {
public:
    explicit Decoder(std::span<const char> data) : data_(data), size_(data.size()) {}

    void bytes(void* to, size_t size) {
        if (size > data_.size()) throw FormatError(size_, "ends within a value");
        if (size > 0) std::memcpy(to, data_.data(), size);
        data_ = data_.subspan(size);
    }
    void zeros(size_t size) {
        if (size > data_.size()) throw FormatError(size_, "ends within padding");
        data_ = data_.subspan(size);
    }
    /** Resizes `items` to the count in the buffer. Refuses an impossible count before allocating memory. */
    template <class Items>
    void count(Items& items) {
        uint64_t wanted = 0;
        scalar(wanted);
        if (wanted > data_.size() / minimumSize<typename Items::value_type>())
            throw FormatError(taken() - sizeof wanted,
                              "announces " + std::to_string(wanted) + " elements, more than it holds");
        items.resize(wanted);
    }
    void scalar(auto& value) { bytes(&value, sizeof value); }
    void scalar(bool& value) {
        uint8_t byte = 0;
        scalar(byte);
        value = byte != 0;
    }
    template <class T>
    void block(std::vector<T>& items) {
        bytes(items.data(), items.size() * sizeof(T));
    }
    size_t left() const { return data_.size(); }
    size_t taken() const { return size_ - data_.size(); }

private:
    std::span<const char> data_;
    size_t size_;
};

/** Visits the parts of a value in wire order, for an Encoder (const values) or a Decoder. */
template <class Archive>
class Walk {
public:
    explicit Walk(Archive& archive) : archive_(archive) {}

    template <class T>
    void value(T& item) {
        using Plain = std::remove_const_t<T>;
        if constexpr (types::Described<Plain>)
            fields(item);
        else {
            flushPadding();
            if constexpr (Text<Plain>)
                text(item);
            else if constexpr (Vector<Plain>)
                elements(item);
            else if constexpr (Quaternion<Plain>)
                quaternion(item);
            else
                archive_.scalar(item);
        }
    }

private:
    template <class T>
    void fields(T& item) {
        using Plain = std::remove_const_t<T>;
        Extent extent;
        auto visit = [&](const types::Field&, auto& field) {
            const size_t end = extent.size;
            padding_ += extent.append(getExtent<std::remove_cvref_t<decltype(field)>>()) - end;
            value(field);
        };
        Plain::describe(item, visit);
        padding_ += extent.stride() - extent.size;
    }
    void text(auto& item) {
        archive_.count(item);
        archive_.bytes(item.data(), item.size());
    }
    template <class T>
    void elements(T& items) {
        archive_.count(items);
        if constexpr (Bulk<typename T::value_type>)
            archive_.block(items);
        else
            for (auto& item : items) {
                value(item);
                flushPadding();
            }
    }
    void quaternion(auto& q) {
        archive_.scalar(q.x);
        archive_.scalar(q.y);
        archive_.scalar(q.z);
        archive_.scalar(q.w);
    }
    void flushPadding() { archive_.zeros(std::exchange(padding_, 0)); }

    Archive& archive_;
    size_t padding_ = 0;  ///< Due before the next value; dropped at the end [B].
};

/** Appends the sample to `bytes`. */
void marshal(const auto& sample, std::vector<char>& bytes) {
    Encoder encoder(bytes);
    Walk<Encoder>(encoder).value(sample);
}

/** Fills `sample`, reusing its memory. Throws FormatError unless `bytes` is exactly one sample. */
void unmarshal(std::span<const char> bytes, auto& sample) {
    Decoder decoder(bytes);
    Walk<Decoder>(decoder).value(sample);
    if (decoder.left() > 0)
        throw FormatError(decoder.taken(), "has " + std::to_string(decoder.left()) + " bytes too many");
}

}  // namespace insonify::log::pocolog
