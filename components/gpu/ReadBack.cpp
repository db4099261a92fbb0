#include "components/gpu/ReadBack.hpp"

#include "components/gpu/EglContext.hpp"

namespace insonify::gpu {

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

}  // namespace insonify::gpu
