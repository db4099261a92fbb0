#include "components/sonar/SlabPicture.hpp"

#include <algorithm>
#include <array>

namespace insonify::sonar {
namespace {

/** Which sample lies in which quarter of a pixel, of the framebuffer that is bound: left below, right below, above. */
std::array<GLint, 4> samplesOfQuarters() {
    std::array<GLint, 4> samples = {-1, -1, -1, -1};
    for (GLuint i = 0; i < 4; ++i) {
        float at[2];
        glGetMultisamplefv(GL_SAMPLE_POSITION, i, at);
        samples[(at[0] > 0.5f ? 1u : 0u) + (at[1] > 0.5f ? 2u : 0u)] = static_cast<GLint>(i);
    }
    if (std::ranges::count(samples, -1) > 0) throw gpu::GlError("this device has no sample in some quarter of a pixel");
    return samples;
}

}  // namespace

struct SlabPicture::Multisampled {
    Multisampled(const Slab& slab, GLenum format, gpu::EglContext& context)
        : columns(slab.columns / 2),
          rows(slab.rows / 2),
          ids(gpu::Texture::multisampled(format, columns, rows, 4)),
          depth(gpu::Texture::multisampled(GL_DEPTH_COMPONENT32F, columns, rows, 4)),
          target(ids, depth),
          resolve(context.programs().raster("resolve.vert.glsl", "resolve.frag.glsl", {})),
          sample_of_quarter(glGetUniformLocation(resolve.id(), "sample_of_quarter")) {
        target.bind();
        order = samplesOfQuarters();
    }

    int columns, rows;
    gpu::Texture ids, depth;
    gpu::Framebuffer target;
    const gpu::Program& resolve;
    GLint sample_of_quarter;
    gpu::VertexArray none;
    std::array<GLint, 4> order;
};

SlabPicture::SlabPicture(const Slab& slab, bool with_normal_maps, size_t run_limit, gpu::EglContext& context)
    : slab_(slab),
      channels_(with_normal_maps ? 4 : 2),
      ids_(with_normal_maps ? GL_RGBA32UI : GL_RG32UI, slab.columns, slab.rows),
      depth_(GL_DEPTH_COMPONENT32F, slab.columns, slab.rows),
      target_(ids_, depth_),
      device_clips_(run_limit * sizeof(Clip)),
      device_bends_(with_normal_maps ? run_limit * sizeof(Bend) : sizeof(Bend)),
      device_draws_(run_limit * sizeof(DrawCommand)) {
    runs.reserve(run_limit);
    commands.reserve(run_limit);
    clips.reserve(run_limit);
    if (with_normal_maps) bends.reserve(run_limit);
    draws.reserve(run_limit);
    if (slab.samples == 4)
        multisampled_ = std::make_unique<Multisampled>(slab, with_normal_maps ? GL_RGBA32UI : GL_RG32UI, context);
}

SlabPicture::~SlabPicture() = default;

void SlabPicture::read(std::vector<uint32_t>& words) const {
    ids_.bind(0);  // so that what another context drew is seen here
    glGetTextureImage(ids_.id(), 0, channels_ == 4 ? GL_RGBA_INTEGER : GL_RG_INTEGER, GL_UNSIGNED_INT,
                      static_cast<GLsizei>(words.size() * sizeof(uint32_t)), words.data());
}

void SlabPicture::clear() const {
    target_.bind();
    glViewport(0, 0, slab_.columns, slab_.rows);
    const GLuint miss[4] = {};
    glClearBufferuiv(GL_COLOR, 0, miss);
    glClear(GL_DEPTH_BUFFER_BIT);
    if (!multisampled_) return;
    multisampled_->target.bind();
    glViewport(0, 0, multisampled_->columns, multisampled_->rows);
    glClearBufferuiv(GL_COLOR, 0, miss);
    glClear(GL_DEPTH_BUFFER_BIT);
}

void SlabPicture::resolve() const {
    if (!multisampled_) return;
    target_.bind();
    glViewport(0, 0, slab_.columns, slab_.rows);
    glDisable(GL_DEPTH_TEST);
    multisampled_->resolve.use();
    const auto& order = multisampled_->order;
    glUniform4i(multisampled_->sample_of_quarter, order[0], order[1], order[2], order[3]);
    multisampled_->ids.bind(0);
    multisampled_->none.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
}

void SlabPicture::upload(bool with_draws) {
    device_clips_.write(clips.data(), clips.size() * sizeof(Clip));
    if (!bends.empty()) device_bends_.write(bends.data(), bends.size() * sizeof(Bend));
    if (with_draws) device_draws_.write(draws.data(), draws.size() * sizeof(DrawCommand));
}

}  // namespace insonify::sonar
