#pragma once
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
 *  the bytes are wanted. One read at a time. */
class ReadBack {
public:
    ReadBack() = default;
    explicit ReadBack(size_t bytes);
    size_t bytes() const { return bytes_; }
    /** Asks for the first bytes of `from`, once all that was asked for before is done. */
    void ask(const Buffer& from);
    /** The same of the picture in a texture, row by row from below; `format` as GL_RG_INTEGER, of 32-bit words. */
    void ask(const Texture& from, GLenum format);
    /** Waits for what was asked for last; valid until the next is asked for. */
    const void* wait() const;

private:
    size_t bytes_ = 0;
    Buffer buffer_;
    const void* mapped_ = nullptr;
    Fence asked_;
};

}  // namespace insonify::gpu
