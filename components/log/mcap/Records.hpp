#pragma once
// The frame of an MCAP file: a magic, then records (one byte of kind, eight of length, content), the last of them a
// footer, then the magic again. All integers are little endian.
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "components/log/Stream.hpp"

namespace insonify::log::mcap {

inline constexpr std::string_view magic{"\x89MCAP0\r\n", 8};
inline constexpr size_t record_header_size = 9;  ///< [B]

enum class Op : uint8_t {
    Header = 1,
    Footer,
    Schema,
    Channel,
    Message,
    Chunk,
    MessageIndex,
    ChunkIndex,
    Attachment,
    AttachmentIndex,
    Statistics,
    Metadata,
    MetadataIndex,
    SummaryOffset,
    DataEnd
};

using Texts = Metadata;

/** Appends records to a buffer: begin(), the fields, end(). */
class RecordWriter {
public:
    explicit RecordWriter(std::vector<char>& bytes) : bytes_(bytes) {}

    void begin(Op op) {
        number(op);
        number(uint64_t{0});
        start_ = bytes_.size();
    }
    void end() {
        const uint64_t length = bytes_.size() - start_;
        std::memcpy(bytes_.data() + start_ - sizeof length, &length, sizeof length);
    }
    template <class T>
    void number(T value) {
        raw({reinterpret_cast<const char*>(&value), sizeof value});
    }
    void text(std::string_view text) {
        number(static_cast<uint32_t>(text.size()));
        raw(text);
    }
    void texts(const Texts& texts) {
        sized([&] {
            for (const auto& [key, value] : texts) {
                text(key);
                text(value);
            }
        });
    }
    /** Appends what `fill` appends, preceded by its size in four bytes. */
    void sized(auto&& fill) {
        number(uint32_t{0});
        const size_t from = bytes_.size();
        fill();
        const auto size = static_cast<uint32_t>(bytes_.size() - from);
        std::memcpy(bytes_.data() + from - sizeof size, &size, sizeof size);
    }
    void raw(std::string_view data);

private:
    std::vector<char>& bytes_;
    size_t start_ = 0;
};

/** Reads the fields of one record; throws FormatError where it ends too early. */
class RecordReader {
public:
    /** @param at place of the bytes in the file [B] */
    RecordReader(std::span<const char> bytes, uint64_t at) : bytes_(bytes), at_(at) {}

    template <class T>
    T number() {
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string text() { return std::string(sized()); }
    Texts texts() {
        RecordReader pairs = part();
        Texts texts;
        while (pairs.left() > 0) {
            std::string key = pairs.text();
            texts[std::move(key)] = pairs.text();
        }
        return texts;
    }
    std::string_view sized() { return take(number<uint32_t>()); }
    /** Returns the bytes after a size of four bytes. */
    RecordReader part() {
        const std::string_view bytes = sized();
        return {bytes, at_ - bytes.size()};
    }
    std::string_view take(uint64_t size) {
        if (size > bytes_.size())
            throw FormatError(at_, "the record ends here, within a field of " + std::to_string(size) + " bytes");
        const std::string_view taken(bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
        at_ += size;
        return taken;
    }
    std::string_view rest() { return take(bytes_.size()); }
    size_t left() const { return bytes_.size(); }
    uint64_t at() const { return at_; }

private:
    std::span<const char> bytes_;
    uint64_t at_;
};

}  // namespace insonify::log::mcap
