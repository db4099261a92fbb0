#include "components/gpu/Objects.hpp"

#include <algorithm>
#include <bit>

#include "components/gpu/EglContext.hpp"

namespace insonify::gpu {
namespace {

GLuint created(auto create) {
    GLuint id = 0;
    create(id);
    return id;
}

}  // namespace

void Fence::wait() const {
    constexpr GLuint64 second = 1'000'000'000;
    GLenum state = sync_ ? GL_TIMEOUT_EXPIRED : GL_ALREADY_SIGNALED;
    while (state == GL_TIMEOUT_EXPIRED) state = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, second);
    if (state == GL_WAIT_FAILED) throw GlError("the device did not end its work; was the context lost?");
}

ReadBack::ReadBack(size_t bytes)
    : bytes_(bytes), buffer_(bytes, nullptr, GL_MAP_READ_BIT | mapped_for_good | GL_CLIENT_STORAGE_BIT) {
    mapped_ = buffer_.map(GL_MAP_READ_BIT | mapped_for_good);
}

void ReadBack::ask(const Buffer& from) {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    glCopyNamedBufferSubData(from.id(), buffer_.id(), 0, 0, static_cast<GLsizeiptr>(bytes_));
    asked_ = Fence::here();
}

void ReadBack::ask(const Texture& from, GLenum format) {
    buffer_.bind(GL_PIXEL_PACK_BUFFER);
    glGetTextureImage(from.id(), 0, format, GL_UNSIGNED_INT, static_cast<GLsizei>(bytes_), nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    asked_ = Fence::here();
}

const void* ReadBack::wait() const {
    asked_.wait();
    return mapped_;
}

Buffer::Buffer(size_t bytes, const void* data, GLbitfield flags)
    : name_(created([](GLuint& id) { glCreateBuffers(1, &id); }), [](GLuint id) { glDeleteBuffers(1, &id); }),
      bytes_(std::max<size_t>(bytes, 16)) {
    glNamedBufferStorage(id(), static_cast<GLsizeiptr>(bytes_), bytes >= 16 ? data : nullptr, flags);
    if (data && bytes > 0 && bytes < 16) write(data, bytes);
}

void Buffer::write(const void* data, size_t bytes, size_t offset) {
    glNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::read(void* data, size_t bytes, size_t offset) const {
    glGetNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::clear() { glClearNamedBufferData(id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr); }

void* Buffer::map(GLbitfield access) const {
    void* bytes = glMapNamedBufferRange(id(), 0, static_cast<GLsizeiptr>(bytes_), access);
    if (!bytes) throw GlError("this device shares no memory of " + std::to_string(bytes_) + " bytes");
    return bytes;
}

Texture::Texture(GLenum format, int width, int height, bool mipmapped)
    : name_(created([](GLuint& id) { glCreateTextures(GL_TEXTURE_2D, 1, &id); }),
            [](GLuint id) { glDeleteTextures(1, &id); }) {
    const int levels = mipmapped ? std::bit_width(static_cast<unsigned>(std::max(width, height))) : 1;
    glTextureStorage2D(id(), levels, format, width, height);
    if (mipmapped) return;
    glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);  // integers cannot be blended
    glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

Texture Texture::multisampled(GLenum format, int width, int height, int samples) {
    Texture texture;
    texture.name_ = Name(created([](GLuint& id) { glCreateTextures(GL_TEXTURE_2D_MULTISAMPLE, 1, &id); }),
                         [](GLuint id) { glDeleteTextures(1, &id); });
    glTextureStorage2DMultisample(texture.id(), samples, format, width, height, GL_TRUE);
    return texture;
}

Framebuffer::Framebuffer(const Texture& colour, const Texture& depth)
    : name_(created([](GLuint& id) { glCreateFramebuffers(1, &id); }),
            [](GLuint id) { glDeleteFramebuffers(1, &id); }) {
    glNamedFramebufferTexture(id(), GL_COLOR_ATTACHMENT0, colour.id(), 0);
    glNamedFramebufferTexture(id(), GL_DEPTH_ATTACHMENT, depth.id(), 0);
    if (glCheckNamedFramebufferStatus(id(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw GlError("this device cannot draw into a 32-bit float picture of the size asked");
}

VertexArray::VertexArray()
    : name_(created([](GLuint& id) { glCreateVertexArrays(1, &id); }),
            [](GLuint id) { glDeleteVertexArrays(1, &id); }) {}

void VertexArray::attribute(GLuint location, const Buffer& buffer, int components) const {
    glVertexArrayVertexBuffer(id(), location, buffer.id(), 0, components * static_cast<int>(sizeof(float)));
    glEnableVertexArrayAttrib(id(), location);
    glVertexArrayAttribFormat(id(), location, components, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(id(), location, location);
}

void VertexArray::instanceRows(GLuint location, const Buffer& buffer, int rows) const {
    constexpr int row_bytes = 4 * static_cast<int>(sizeof(float));
    glVertexArrayVertexBuffer(id(), location, buffer.id(), 0, rows * row_bytes);
    glVertexArrayBindingDivisor(id(), location, 1);
    for (int row = 0; row < rows; ++row) {
        const GLuint at = location + static_cast<GLuint>(row);
        glEnableVertexArrayAttrib(id(), at);
        glVertexArrayAttribFormat(id(), at, 4, GL_FLOAT, GL_FALSE, static_cast<GLuint>(row * row_bytes));
        glVertexArrayAttribBinding(id(), at, location);
    }
}

}  // namespace insonify::gpu
