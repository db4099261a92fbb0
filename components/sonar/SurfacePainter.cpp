#include "components/sonar/SurfacePainter.hpp"

namespace insonify::sonar {

SurfacePainter::SurfacePainter(const SurfaceScene& scene, const std::vector<std::string>& defines, double near_plane,
                               gpu::EglContext& context)
    : scene_(scene),
      near_plane_(near_plane),
      software_(context.isSoftware()),
      program_(context.programs().raster("surface.vert.glsl", "surface.frag.glsl", defines)) {
    const auto at = [&](const char* name) { return glGetUniformLocation(program_.id(), name); };
    uniforms_ = {at("extent"), at("pixel_size"), at("near_plane"), at("mapped")};
    scene_.describe(vertices_);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glClearDepth(0);
}

void SurfacePainter::draw(const VisibilityBuffer& picture, const Draws& draws) const {
    picture.clear();
    if (draws.groups.empty()) return;
    program_.use();
    setUniforms(picture.frustum());
    vertices_.instanceRows(1, *draws.clips, 3);
    if (scene_.withNormalMaps()) vertices_.instanceRows(7, *draws.normal_transforms, 6);
    vertices_.bind();
    for (const DrawGroup& group : draws.groups) drawGroup(draws, group);
    picture.resolve();
}

void SurfacePainter::setUniforms(const ViewFrustum& frustum) const {
    glUniform2f(uniforms_.extent, static_cast<float>(frustum.extent_u), static_cast<float>(frustum.extent_v));
    const double side = frustum.samples == 4 ? 2 : 1;
    glUniform2f(uniforms_.pixel_size, static_cast<float>(side * frustum.du()), static_cast<float>(side * frustum.dv()));
    glUniform1f(uniforms_.near_plane, static_cast<float>(near_plane_));
}

/** Mesa's software renderer would take indirect commands one by one all the same, but look for each through what all
 *  contexts draw: see EglContext::drawing(). */
void SurfacePainter::drawGroup(const Draws& draws, const DrawGroup& group) const {
    const auto offset = [](size_t bytes) { return reinterpret_cast<const void*>(bytes); };
    scene_.bindNormalMap(group.normal_map);
    glUniform1i(uniforms_.mapped, group.normal_map >= 0);
    if (!software_ || draws.known.empty()) {
        draws.indirect->bind(GL_DRAW_INDIRECT_BUFFER);
        glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, offset(group.first * sizeof(DrawCommand)),
                                    static_cast<GLsizei>(group.last - group.first), sizeof(DrawCommand));
        return;
    }
    for (const DrawCommand& draw : draws.known.subspan(group.first, group.last - group.first))
        glDrawElementsInstancedBaseVertexBaseInstance(GL_TRIANGLES, static_cast<GLsizei>(draw.count), GL_UNSIGNED_INT,
                                                      offset(draw.first_index * sizeof(uint32_t)), 1,
                                                      static_cast<GLint>(draw.base_vertex), draw.base_instance);
}

}  // namespace insonify::sonar
