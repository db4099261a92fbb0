#pragma once
#include <deque>
#include <optional>
#include <utility>

#include "components/viewer/Frame.hpp"

namespace insonify::viewer {

/** Queues frames for one client, which may be slow or not read at all. Keeps only the newest frame of each stream and
 *  counts the replaced frames. Not thread-safe. */
class SendQueue {
public:
    static constexpr size_t max_replies = 64;
    /** Stream of the time, beyond all streams of 32 bits. A replaced frame of it is not counted. */
    static constexpr uint64_t time_stream = uint64_t{1} << 32;

    /** Queues a frame of a stream, replacing an older frame that still waits. */
    void put(uint64_t stream, Frame frame) {
        for (auto& [key, waiting] : streams_)
            if (key == stream) {
                if (stream != time_stream) ++dropped_;
                waiting = std::move(frame);
                return;
            }
        streams_.emplace_back(stream, std::move(frame));
    }
    /** Queues a frame that must arrive, before the frames of streams. With `of` it replaces an older posted frame of
     *  that stream that still waits. Returns false if too many wait: the client must be disconnected. */
    bool post(Frame frame, std::optional<uint64_t> of = {}) {
        for (auto& [key, waiting] : replies_)
            if (of && key == of) {
                waiting = std::move(frame);
                return true;
            }
        if (replies_.size() == max_replies) return false;
        replies_.emplace_back(of, std::move(frame));
        return true;
    }
    /** Returns the next frame to send: replies first, then the stream that has waited longest. */
    std::optional<Frame> next() {
        if (!replies_.empty()) {
            Frame frame = std::move(replies_.front().second);
            replies_.pop_front();
            return frame;
        }
        if (streams_.empty()) return std::nullopt;
        Frame frame = std::move(streams_.front().second);
        streams_.pop_front();
        return frame;
    }
    void forget(uint64_t stream) {
        const auto is_of_it = [stream](const auto& waiting) { return waiting.first == stream; };
        std::erase_if(replies_, is_of_it);
        std::erase_if(streams_, is_of_it);
    }
    uint64_t dropped() const { return dropped_; }  ///< Frames [1].

private:
    std::deque<std::pair<std::optional<uint64_t>, Frame>> replies_;
    std::deque<std::pair<uint64_t, Frame>> streams_;
    uint64_t dropped_ = 0;
};

}  // namespace insonify::viewer
