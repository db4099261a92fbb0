#include "components/sonar/raster/VisibilityBuffer.hpp"

#include <algorithm>
#include <array>

namespace insonify::sonar {
namespace {

/** Returns the sample in each quarter of a pixel, in the bound framebuffer: left below, right below, above. */
std::array<GLint, 4> samplesOfQuarters() {
    std::array<GLint, 4> samples = {-1, -1, -1, -1};
    for (GLuint i = 0; i < 4; ++i) {
        float at[2];
        glGetMultisamplefv(GL_SAMPLE_POSITION, i, at);
        samples[(at[0] > 0.5f ? 1u : 0u) + (at[1] > 0.5f ? 2u : 0u)] = static_cast<GLint>(i);
    }
    if (std::ranges::count(samples, -1) > 0) throw gpu::GlError("this device has no sample in one quarter of a pixel");
    return samples;
}

}  // namespace

struct VisibilityBuffer::Multisampled {
    Multisampled(const ViewFrustum& frustum, GLenum format, gpu::EglContext& context)
        : columns(frustum.columns / 2),
          rows(frustum.rows / 2),
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

VisibilityBuffer::VisibilityBuffer(const ViewFrustum& frustum, bool with_normal_maps, gpu::EglContext& context)
    : frustum_(frustum),
      channels_(with_normal_maps ? 4 : 2),
      ids_(with_normal_maps ? GL_RGBA32UI : GL_RG32UI, frustum.columns, frustum.rows),
      depth_(GL_DEPTH_COMPONENT32F, frustum.columns, frustum.rows),
      target_(ids_, depth_) {
    if (frustum.samples == 4)
        multisampled_ = std::make_unique<Multisampled>(frustum, with_normal_maps ? GL_RGBA32UI : GL_RG32UI, context);
}

VisibilityBuffer::~VisibilityBuffer() = default;

size_t VisibilityBuffer::bytes() const {
    return sizeof(uint32_t) * static_cast<size_t>(channels_) * static_cast<size_t>(frustum_.columns) *
           static_cast<size_t>(frustum_.rows);
}

void VisibilityBuffer::read(gpu::ReadBack& words) const {
    ids_.bind(0);  // makes another context's writes visible here
    words.ask(ids_, channels_ == 4 ? GL_RGBA_INTEGER : GL_RG_INTEGER);
}

void VisibilityBuffer::clear() const {
    target_.bind();
    glViewport(0, 0, frustum_.columns, frustum_.rows);
    const GLuint miss[4] = {};
    glClearBufferuiv(GL_COLOR, 0, miss);
    glClear(GL_DEPTH_BUFFER_BIT);
    if (!multisampled_) return;
    multisampled_->target.bind();
    glViewport(0, 0, multisampled_->columns, multisampled_->rows);
    glClearBufferuiv(GL_COLOR, 0, miss);
    glClear(GL_DEPTH_BUFFER_BIT);
}

void VisibilityBuffer::resolve() const {
    if (!multisampled_) return;
    target_.bind();
    glViewport(0, 0, frustum_.columns, frustum_.rows);
    glDisable(GL_DEPTH_TEST);
    multisampled_->resolve.use();
    const auto& order = multisampled_->order;
    glUniform4i(multisampled_->sample_of_quarter, order[0], order[1], order[2], order[3]);
    multisampled_->ids.bind(0);
    multisampled_->none.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
}

}  // namespace insonify::sonar
