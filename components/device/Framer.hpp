#pragma once
#include <optional>
#include <utility>

#include "components/device/Bytes.hpp"

namespace insonify::device {

/** Finds the frames of a protocol in bytes as they come, whatever lies between them. What begins like a frame and is
 *  none is passed over by a byte, so that a frame within it is found. */
class Framer {
public:
    virtual ~Framer() = default;

    void add(std::span<const uint8_t> bytes) {
        bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_));
        erased_ += std::exchange(begin_, 0);
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    size_t skipped() const { return skipped_; }                ///< Bytes that were of no frame.
    size_t waiting() const { return bytes_.size() - begin_; }  ///< Bytes that are kept until more come.
    uint64_t position() const { return erased_ + begin_; }     ///< Of these, from the beginning of the stream [B].

protected:
    /** Where a frame is cut off: wait for the rest of it, or look for a whole one behind its beginning, so that a stray
     *  beginning holds up nobody. */
    enum class CutOff { Waits, IsPassedOver };
    explicit Framer(CutOff cut_off) : cut_off_(cut_off) {}

    /** Size of the frame that begins with these bytes; 0: none does. Where it is more than they are, it is the least
     *  that what begins here may have [B]. */
    virtual size_t sizeOf(std::span<const uint8_t> bytes) const = 0;
    /** The next whole frame, until bytes are added; empty: there is none yet. */
    std::span<const uint8_t> nextFrame() {
        std::optional<size_t> cut_off;
        for (size_t at = begin_; at < bytes_.size(); ++at) {
            const auto rest = std::span<const uint8_t>(bytes_).subspan(at);
            const size_t size = sizeOf(rest);
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
    size_t begin_ = 0;  ///< What is before has been read.
    size_t skipped_ = 0;
    uint64_t erased_ = 0;  ///< Bytes that are no longer kept.
};

}  // namespace insonify::device
