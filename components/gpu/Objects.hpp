#pragma once
// OpenGL objects that are made in their constructor and gone with their destructor.
#include <epoxy/gl.h>

#include <cstddef>
#include <span>
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

}  // namespace insonify::gpu
