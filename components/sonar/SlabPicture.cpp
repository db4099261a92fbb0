#include "components/sonar/SlabPicture.hpp"

namespace insonify::sonar {

SlabPicture::SlabPicture(const Slab& slab, bool with_normal_maps, size_t run_limit)
    : slab_(slab),
      channels_(with_normal_maps ? 4 : 2),
      ids_(with_normal_maps ? GL_RGBA32UI : GL_RG32UI, slab.columns, slab.rows),
      depth_(GL_DEPTH_COMPONENT32F, slab.columns, slab.rows),
      target_(ids_, depth_),
      device_commands_(run_limit * sizeof(CommandRecord)),
      device_clips_(run_limit * sizeof(Clip)),
      device_draws_(run_limit * sizeof(DrawCommand)) {
    runs.reserve(run_limit);
    commands.reserve(run_limit);
    clips.reserve(run_limit);
    draws.reserve(run_limit);
}

void SlabPicture::read(std::vector<uint32_t>& words) const {
    ids_.bind(0);  // so that what another context drew is seen here
    glGetTextureImage(ids_.id(), 0, channels_ == 4 ? GL_RGBA_INTEGER : GL_RG_INTEGER, GL_UNSIGNED_INT,
                      static_cast<GLsizei>(words.size() * sizeof(uint32_t)), words.data());
}

void SlabPicture::bindCommands() const { device_commands_.bindBase(GL_SHADER_STORAGE_BUFFER, COMMANDS_BINDING); }

void SlabPicture::clear() const {
    target_.bind();
    glViewport(0, 0, slab_.columns, slab_.rows);
    const GLuint miss[4] = {};
    glClearBufferuiv(GL_COLOR, 0, miss);
    glClear(GL_DEPTH_BUFFER_BIT);
}

void SlabPicture::upload() {
    device_commands_.write(commands.data(), commands.size() * sizeof(CommandRecord));
    device_clips_.write(clips.data(), clips.size() * sizeof(Clip));
    device_draws_.write(draws.data(), draws.size() * sizeof(DrawCommand));
    device_draws_.bind(GL_DRAW_INDIRECT_BUFFER);
}

}  // namespace insonify::sonar
