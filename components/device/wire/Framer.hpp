#pragma once
#include <optional>
#include <utility>

#include "components/device/wire/Bytes.hpp"

namespace insonify::device {

/** Finds the frames of a protocol in a stream of bytes, with anything between them. At a false beginning it advances by
 *  one byte, so that a frame within is found. */
class Framer {
public:
    virtual ~Framer() = default;

    void add(std::span<const uint8_t> bytes) {
        bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_));
        erased_ += std::exchange(begin_, 0);
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    size_t skipped() const { return skipped_; }                ///< Bytes outside of frames.
    size_t waiting() const { return bytes_.size() - begin_; }  ///< Bytes that are kept until more arrive.
    uint64_t position() const { return erased_ + begin_; }     ///< Their place in the stream [B].

protected:
    /** What to do with an incomplete frame: wait for its rest, or search for a complete frame behind its beginning, so
     *  that a false beginning delays nothing. */
    enum class CutOff { Waits, IsPassedOver };
    explicit Framer(CutOff cut_off) : cut_off_(cut_off) {}

    /** Returns the size of the frame at the beginning of the bytes; 0: there is none. If the frame is incomplete,
     *  returns the min size that it may have [B]. */
    virtual size_t getSize(std::span<const uint8_t> bytes) const = 0;
    /** Returns the next complete frame, valid until bytes are added; empty: there is none yet. */
    std::span<const uint8_t> nextFrame() {
        std::optional<size_t> cut_off;
        for (size_t at = begin_; at < bytes_.size(); ++at) {
            const auto rest = std::span<const uint8_t>(bytes_).subspan(at);
            const size_t size = getSize(rest);
            if (size > 0 && size <= rest.size()) {
                skip(at - begin_);
                begin_ += size;
                return rest.first(size);
            }
            if (size > 0 && !cut_off) cut_off = at;
            if (cut_off && cut_off_ == CutOff::Waits) break;
        }
        skip(cut_off.value_or(bytes_.size()) - begin_);
        return {};
    }
    void skip(size_t bytes) {
        begin_ += bytes;
        skipped_ += bytes;
    }

private:
    CutOff cut_off_;
    Bytes bytes_;
    size_t begin_ = 0;  ///< Earlier bytes have been read.
    size_t skipped_ = 0;
    uint64_t erased_ = 0;  ///< Bytes that have been removed.
};

}  // namespace insonify::device
