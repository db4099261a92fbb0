#pragma once
// OpenGL objects that are made in their constructor and gone with their destructor.
#include <epoxy/gl.h>

#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

namespace insonify::gpu {

/** Owns one OpenGL name; moves, never copies. */
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

/** How a buffer is made and mapped that processor and device see at the same time, as long as it lives. */
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
    void clear();  ///< All bytes zero.
    /** All of it, seen by the processor; `access` as it was made with. Throws GlError when the device shares none. */
    void* map(GLbitfield access) const;
    void bind(GLenum target) const { glBindBuffer(target, id()); }
    void bindBase(GLenum target, GLuint index) const { glBindBufferBase(target, index, id()); }

private:
    Name name_;
    size_t bytes_ = 0;
};

/** A two-dimensional texture with one level, or with all when `mipmapped`. */
class Texture {
public:
    Texture() = default;
    Texture(GLenum format, int width, int height, bool mipmapped = false);
    /** With several samples a pixel, at places that are the device's. */
    static Texture multisampled(GLenum format, int width, int height, int samples);
    GLuint id() const { return name_.id(); }
    void bind(GLuint unit) const { glBindTextureUnit(unit, id()); }

private:
    Name name_;
};

class Framebuffer {
public:
    Framebuffer() = default;
    /** Throws GlError when the device cannot draw into these. */
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
    /** Floats, `components` a vertex, tightly packed, as attribute `location`. */
    void attribute(GLuint location, const Buffer& buffer, int components) const;
    /** Attributes `location` to `location + rows - 1` from rows of four floats: the same for all vertices of an
     *  instance. */
    void instanceRows(GLuint location, const Buffer& buffer, int rows) const;
    void indices(const Buffer& buffer) const { glVertexArrayElementBuffer(id(), buffer.id()); }

private:
    Name name_;
};

/** A list in memory that the processor writes and the device reads, with no call between: a command sees what was
 *  written before it was asked for. Who writes there anew waits first for a fence behind the last command that reads.
 *  Only to be written: for the processor, such memory may be slow to read. */
template <class T>
class UploadList {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    UploadList() = default;
    /** With room for so many, which is all that there ever is. */
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

}  // namespace insonify::gpu
