#pragma once
#include <cstddef>

#include "components/gpu/Objects.hpp"

namespace insonify::gpu {

/** A point in the sequence of a context's commands. */
class Fence {
public:
    Fence() = default;  ///< Behind no command: wait() returns at once.
    /** Returns a fence behind all commands so far. */
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
    /** Waits until all commands before the fence are done. Throws GlError when the device has failed. */
    void wait() const;

private:
    GLsync sync_ = nullptr;
};

/** Reads bytes back from the device into memory that both sides see. A read is queued like a draw; only wait() blocks.
 *  One read at a time. */
class ReadBack {
public:
    ReadBack() = default;
    explicit ReadBack(size_t bytes);
    size_t bytes() const { return bytes_; }
    /** Queues a read of the first bytes of `from`, after all earlier commands. */
    void ask(const Buffer& from);
    /** Queues a read of a texture of 32-bit words, row by row from below; `format` is such as GL_RG_INTEGER. */
    void ask(const Texture& from, GLenum format);
    /** Waits for the last read and returns its bytes, which are valid until the next read. */
    const void* wait() const;

private:
    size_t bytes_ = 0;
    Buffer buffer_;
    const void* mapped_ = nullptr;
    Fence asked_;
};

}  // namespace insonify::gpu
