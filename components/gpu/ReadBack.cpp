#include "components/gpu/ReadBack.hpp"

#include "components/gpu/EglContext.hpp"

namespace insonify::gpu {

void Fence::wait() const {
    constexpr GLuint64 second = 1'000'000'000;
    GLenum state = sync_ ? GL_TIMEOUT_EXPIRED : GL_ALREADY_SIGNALED;
    while (state == GL_TIMEOUT_EXPIRED) state = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, second);
    if (state == GL_WAIT_FAILED) throw GlError("the device did not end its work; was the context lost?");
}

ReadBack::ReadBack(size_t bytes) : bytes_(bytes) {
    constexpr GLbitfield shared = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    for (Place& place : places_) {
        place.buffer = Buffer(bytes, nullptr, shared | GL_CLIENT_STORAGE_BIT);
        place.mapped =
            glMapNamedBufferRange(place.buffer.id(), 0, static_cast<GLsizeiptr>(place.buffer.bytes()), shared);
        if (!place.mapped) throw GlError("this device shares no memory of " + std::to_string(bytes) + " bytes");
    }
}

void ReadBack::ask(const Buffer& from) {
    at_ = 1 - at_;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    glCopyNamedBufferSubData(from.id(), places_[at_].buffer.id(), 0, 0, static_cast<GLsizeiptr>(bytes_));
    asked_ = Fence::here();
}

const void* ReadBack::wait() const {
    asked_.wait();
    return places_[at_].mapped;
}

}  // namespace insonify::gpu
