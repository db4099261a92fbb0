#pragma once
// OpenGL objects that are made in their constructor and deleted in their destructor.
#include <epoxy/gl.h>

#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

namespace insonify::gpu {

/** Owner of one OpenGL name; movable, not copyable. */
class Name {
public:
    using Delete = void (*)(GLuint);
    Name() = default;
    Name(GLuint id, Delete destroy) : id_(id), destroy_(destroy) {}
    Name(Name&& other) noexcept : id_(std::exchange(other.id_, 0)), destroy_(other.destroy_) {}
    Name& operator=(Name&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(destroy_, other.destroy_);
        return *this;
    }
    ~Name() {
        if (id_) destroy_(id_);
    }
    GLuint id() const { return id_; }

private:
    GLuint id_ = 0;
    Delete destroy_ = nullptr;
};

/** Flags of a buffer that stays mapped for its lifetime, so that processor and device see it at the same time. */
constexpr GLbitfield mapped_for_good = GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;

/** Memory on the device. */
class Buffer {
public:
    Buffer() = default;
    explicit Buffer(size_t bytes, const void* data = nullptr, GLbitfield flags = GL_DYNAMIC_STORAGE_BIT);
    template <class T>
    static Buffer of(std::span<const T> items) {
        return Buffer(items.size_bytes(), items.data());
    }

    GLuint id() const { return name_.id(); }
    size_t bytes() const { return bytes_; }
    void write(const void* data, size_t bytes, size_t offset = 0);
    void read(void* data, size_t bytes, size_t offset = 0) const;
    void clear();  ///< Sets all bytes to zero.
    /** Maps the whole buffer for the processor, with the `access` of its constructor. Throws GlError when the device
     *  does not share the memory. */
    void* map(GLbitfield access) const;
    void bind(GLenum target) const { glBindBuffer(target, id()); }
    void bindBase(GLenum target, GLuint index) const { glBindBufferBase(target, index, id()); }

private:
    Name name_;
    size_t bytes_ = 0;
};

/** A two-dimensional texture with one level, or with all levels when `mipmapped`. */
class Texture {
public:
    Texture() = default;
    Texture(GLenum format, int width, int height, bool mipmapped = false);
    /** Makes a texture with several samples per pixel, at places that the device determines. */
    static Texture multisampled(GLenum format, int width, int height, int samples);
    GLuint id() const { return name_.id(); }
    void bind(GLuint unit) const { glBindTextureUnit(unit, id()); }

private:
    Name name_;
};

class Framebuffer {
public:
    Framebuffer() = default;
    /** Throws GlError when the device cannot rasterise into these textures. */
    Framebuffer(const Texture& colour, const Texture& depth);
    GLuint id() const { return name_.id(); }
    void bind() const { glBindFramebuffer(GL_FRAMEBUFFER, id()); }

private:
    Name name_;
};

class VertexArray {
public:
    VertexArray();
    GLuint id() const { return name_.id(); }
    void bind() const { glBindVertexArray(id()); }
    /** Sets attribute `location` to tightly packed floats, `components` per vertex. */
    void attribute(GLuint location, const Buffer& buffer, int components) const;
    /** Sets attributes `location` to `location + rows - 1` to rows of four floats, which are the same for all vertices
     *  of an instance. */
    void instanceRows(GLuint location, const Buffer& buffer, int rows) const;
    void indices(const Buffer& buffer) const { glVertexArrayElementBuffer(id(), buffer.id()); }

private:
    Name name_;
};

/** A list in memory that the processor writes and the device reads, without a call in between. A command sees the items
 *  that were written before it was issued. Before overwriting items, wait for a fence behind the last command that
 *  reads them. Write only: reading this memory may be slow for the processor. */
template <class T>
class UploadList {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    UploadList() = default;
    /** Makes a list with a fixed capacity of `room` items. */
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
