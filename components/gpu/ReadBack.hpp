#pragma once
#include <array>
#include <cstddef>

#include "components/gpu/Objects.hpp"

namespace insonify::gpu {

/** A point in what a context has been asked for, on its thread. */
class Fence {
public:
    Fence() = default;  ///< Of nothing: nobody waits for it.
    /** Here. */
    static Fence here() {
        Fence fence;
        fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
        return fence;
    }
    Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
    Fence& operator=(Fence&& other) noexcept {
        std::swap(sync_, other.sync_);
        return *this;
    }
    ~Fence() {
        if (sync_) glDeleteSync(sync_);
    }
    /** Returns when all that came before is done. Throws GlError when the device has failed. */
    void wait() const;

private:
    GLsync sync_ = nullptr;
};

/** What comes back from the device, in memory that both see: a read is asked for like a draw, and nobody waits before
 *  the bytes are wanted. Two reads may be under way: what the last one gave stays while the next is on its way. */
class ReadBack {
public:
    ReadBack() = default;
    explicit ReadBack(size_t bytes);
    /** Asks for the first bytes of `from`, once all that was asked for before is done. */
    void ask(const Buffer& from);
    /** Waits for what was asked for last; valid until the next but one is asked for. */
    const void* wait() const;

private:
    struct Place {
        Buffer buffer;
        const void* mapped = nullptr;
    };
    size_t bytes_ = 0;
    std::array<Place, 2> places_;
    size_t at_ = 0;
    Fence asked_;
};

}  // namespace insonify::gpu
